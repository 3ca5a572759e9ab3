// The particles of the MPS method.
#pragma once

#include <cstddef>
#include <cstdint>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed::methods::mps {

/// The kinds of particles of Saito and others. Only moving particles change their positions. Dummy
/// walls fill the space behind a wall, so that it is not taken for a free surface.
enum class Kind : std::uint8_t { moving, erodible, inner_wall, dummy_wall };

/// One array for each quantity, all of one length.
template <int D>
struct Particles {
  AlignedVector<VecD<D>> position;         // m
  AlignedVector<VecD<D>> velocity;         // m/s
  AlignedVector<double> pressure;          // Pa
  AlignedVector<double> mass;              // kg
  AlignedVector<double> relative_density;  // number density over n0
  AlignedVector<double> shear_rate;        // 1/s
  AlignedVector<double> viscosity;         // Pa s, apparent
  /// m/s2, the gradient of the pressure over the density, in the last step. Wall particles have no
  /// acceleration; the array holds their `wall_normal`.
  AlignedVector<VecD<D>> pressure_acceleration;
  AlignedVector<VecD<D>> viscous_acceleration;                // m/s2, in the last step
  AlignedVector<Eigen::Matrix<double, D, D>> elastic_strain;  // see elastic_strain.hpp
  AlignedVector<VecD<D>> elastic_slip;                        // m, along the walls beside it
  AlignedVector<Kind> kind;
  AlignedVector<std::uint32_t> id;
  AlignedVector<std::uint16_t> event;  // for wall particles, the number of the obstacle

  std::size_t size() const { return position.size(); }
  bool moves(std::size_t i) const { return kind[i] == Kind::moving; }
  bool is_wall(std::size_t i) const { return kind[i] >= Kind::inner_wall; }
  const VecD<D>& wall_normal(std::size_t i) const { return pressure_acceleration[i]; }

  /// Calls visit(name, array) for each array.
  template <class Visit>
  void for_each_array(const Visit& visit) {
    visit_arrays(*this, *this, [&](const char* name, auto& array, auto&) { visit(name, array); });
  }
  template <class Visit>
  void for_each_array(const Visit& visit) const {
    visit_arrays(*this, *this, [&](const char* name, auto& array, auto&) { visit(name, array); });
  }
  /// Calls visit(name, array, other's array) for each array; the only list of the arrays.
  template <class Self, class Other, class Visit>
  static void visit_arrays(Self& self, Other& other, const Visit& visit) {
    visit("position", self.position, other.position);
    visit("velocity", self.velocity, other.velocity);
    visit("pressure", self.pressure, other.pressure);
    visit("mass", self.mass, other.mass);
    visit("density", self.relative_density, other.relative_density);
    visit("rate", self.shear_rate, other.shear_rate);
    visit("viscosity", self.viscosity, other.viscosity);
    visit("push", self.pressure_acceleration, other.pressure_acceleration);
    visit("shear", self.viscous_acceleration, other.viscous_acceleration);
    visit("strain", self.elastic_strain, other.elastic_strain);
    visit("slip", self.elastic_slip, other.elastic_slip);
    visit("kind", self.kind, other.kind);
    visit("id", self.id, other.id);
    visit("event", self.event, other.event);
  }

  void resize(std::size_t n) {
    for_each_array([n](const char*, auto& array) { array.resize(n); });
  }
};

}  // namespace snowshed::methods::mps
