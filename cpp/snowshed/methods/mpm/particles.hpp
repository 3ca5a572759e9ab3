// The particles: structure of arrays, sorted by grid block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/particles/id_order.hpp"

namespace snowshed::methods::mpm {

/// State of all particles in D dimensions. Arrays that a scene does not need stay empty.
template <class T, int D>
struct Particles {
  static constexpr int strain_size = D * (D + 1) / 2;

  std::array<AlignedVector<T>, D> cell;        // in cells, relative to the block (ParticleView)
  std::array<AlignedVector<T>, D> velocity;    // m/s
  std::array<AlignedVector<T>, D * D> affine;  // 1/s; not with FLIP
  std::array<AlignedVector<T>, strain_size> be_minus_identity;  // b_e - I
  AlignedVector<T> plastic;  // only with plastic laws or several materials
  AlignedVector<T> mass;     // kg (per metre of width in 2D)
  AlignedVector<std::uint32_t> id;
  AlignedVector<std::uint16_t> event;       // event in which each particle was released
  AlignedVector<std::uint8_t> material_id;  // only with several materials or the energy balance
  std::array<AlignedVector<T>, max_own_numbers> own;  // only with a constitutive law of the user

  bool has_affine = false, has_plastic = false, has_material_id = false;
  int own_numbers = 0;  // arrays of `own` in use

  std::size_t size() const { return mass.size(); }

  /// Calls f(name, array) for every array in use. This is the only list of a particle's values.
  template <class F>
  void for_each_array(F f) {
    each(*this, f);
  }
  template <class F>
  void for_each_array(F f) const {
    each(*this, f);
  }

  void resize(std::size_t n) {
    order_by_id_.clear();
    for_each_array([n](const char*, auto& array) { array.resize(n); });
  }

  ParticleView<T> view() {
    ParticleView<T> v{};
    for (int d = 0; d < D; ++d) {
      v.cell[d] = cell[d].data();
      v.velocity[d] = velocity[d].data();
    }
    for (int k = 0; k < strain_size; ++k) v.be_minus_identity[k] = be_minus_identity[k].data();
    for (int k = 0; k < D * D; ++k) v.affine[k] = affine[k].data();
    v.plastic = plastic.data();
    v.mass = mass.data();
    v.material_id = material_id.data();
    for (int k = 0; k < max_own_numbers; ++k) v.own[k] = own[k].data();
    return v;
  }

  /// Mean velocity of the particles [begin, end), m/s.
  VecD<D> mean_velocity(std::ptrdiff_t begin, std::ptrdiff_t end) const {
    VecD<D> mean;
    for (int d = 0; d < D; ++d)
      mean[d] = std::accumulate(velocity[d].begin() + begin, velocity[d].begin() + end, 0.0);
    return mean / double(end - begin);
  }

  /// Root of the mean square of the particles' speeds, m/s.
  double rms_speed(std::ptrdiff_t begin, std::ptrdiff_t end) const {
    double sum = 0;
    for (const auto& v : velocity)
      sum += std::inner_product(v.begin() + begin, v.begin() + end, v.begin() + begin, 0.0);
    return std::sqrt(sum / double(end - begin));
  }

  /// Stops the particles [begin, end).
  void zero_velocity(std::ptrdiff_t begin, std::ptrdiff_t end) {
    const auto stop = [&](auto& array) {
      std::fill(array.begin() + begin, array.begin() + end, T(0));
    };
    for (auto& v : velocity) stop(v);
    if (has_affine)
      for (auto& c : affine) stop(c);
  }

  /// Whether the `cell`s of the particles [begin, end) lie within the block they refer to.
  bool lie_within_block(std::ptrdiff_t begin, std::ptrdiff_t end) const {
    return std::all_of(cell.begin(), cell.end(), [&](const auto& x) {
      return std::all_of(x.begin() + begin, x.begin() + end,
                         [](T at) { return at >= T(0) && at < T(block_edge<D>); });
    });
  }

  /// One array of each type, as buffers for `permute`.
  using Spare = std::tuple<AlignedVector<T>, AlignedVector<std::uint32_t>,
                           AlignedVector<std::uint16_t>, AlignedVector<std::uint8_t>>;
  Spare spare(std::size_t n) const {
    return {AlignedVector<T>(n), AlignedVector<std::uint32_t>(n), AlignedVector<std::uint16_t>(n),
            AlignedVector<std::uint8_t>(has_material_id ? n : 0)};
  }

  /// Returns the index of each particle, ordered by id. The first call computes the order, which is
  /// then stored until particles are rearranged.
  const std::vector<std::uint32_t>& order_by_id() const {
    if (order_by_id_.size() != size())
      order_by_id_ = snowshed::particles::order_by_id(id.data(), size());
    return order_by_id_;
  }

  /// Rearranges: the new particle i is the old particle order[i]. `spare` has the same size.
  void permute(const std::vector<std::uint32_t>& order, Spare& spare, int threads) noexcept {
    order_by_id_.clear();
    for_each_array([&](const char*, auto& array) {
      auto& sorted = std::get<std::remove_reference_t<decltype(array)>>(spare);
      parallel_for_static(std::ptrdiff_t(order.size()), threads,
                          [&](std::ptrdiff_t i) { sorted[i] = array[order[i]]; });
      array.swap(sorted);
    });
  }

 private:
  template <class Self, class F>
  static void each(Self& self, F& f) {
    static constexpr const char* axis[] = {"0", "1", "2", "3", "4", "5", "6", "7", "8"};
    const auto all = [&f](const char* name, auto& arrays) {
      for (std::size_t k = 0; k < arrays.size(); ++k)
        f((std::string(name) + axis[k]).c_str(), arrays[k]);
    };
    all("cell", self.cell);
    all("velocity", self.velocity);
    if (self.has_affine) all("affine", self.affine);
    all("strain", self.be_minus_identity);
    if (self.has_plastic) f("plastic", self.plastic);
    f("mass", self.mass);
    f("id", self.id);
    f("event", self.event);
    if (self.has_material_id) f("kind", self.material_id);
    for (int k = 0; k < self.own_numbers; ++k)
      f((std::string("own") + axis[k]).c_str(), self.own[std::size_t(k)]);
  }

  mutable std::vector<std::uint32_t> order_by_id_;  // empty if not known
};

}  // namespace snowshed::methods::mpm
