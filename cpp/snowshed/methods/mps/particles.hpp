// The particles of the MPS method.
#pragma once

#include <cstddef>
#include <cstdint>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/vec.hpp"

namespace snowshed {

/// The kinds of particles of Saito and others. All but the moving ones keep their places; dummy
/// walls only fill the space behind a wall, so that it is not taken for a free surface.
enum class MpsKind : std::uint8_t { moving, erodible, inner_wall, dummy_wall };

/// One array for each quantity, all of one length.
template <int D>
struct MpsParticles {
  AlignedVector<VecD<D>> position;  // m
  AlignedVector<VecD<D>> velocity;  // m/s
  AlignedVector<double> pressure;   // Pa
  AlignedVector<double> mass;       // kg
  AlignedVector<double> density;    // number density over n0
  AlignedVector<double> rate;       // 1/s, of shear
  AlignedVector<double> viscosity;  // Pa s, apparent
  AlignedVector<double> support;    // m/s2, by walls, along their normals, in the last step
  AlignedVector<MpsKind> kind;
  AlignedVector<std::uint32_t> id;
  AlignedVector<std::uint16_t> event;

  std::size_t size() const { return position.size(); }
  bool moves(std::size_t i) const { return kind[i] == MpsKind::moving; }
  bool is_wall(std::size_t i) const { return kind[i] >= MpsKind::inner_wall; }

  /// Calls visit(name, array) for each array.
  template <class Self, class Visit>
  static void visit_arrays(Self& self, const Visit& visit) {
    visit("position", self.position);
    visit("velocity", self.velocity);
    visit("pressure", self.pressure);
    visit("mass", self.mass);
    visit("density", self.density);
    visit("rate", self.rate);
    visit("viscosity", self.viscosity);
    visit("support", self.support);
    visit("kind", self.kind);
    visit("id", self.id);
    visit("event", self.event);
  }
  template <class Visit>
  void for_each_array(const Visit& visit) {
    visit_arrays(*this, visit);
  }
  template <class Visit>
  void for_each_array(const Visit& visit) const {
    visit_arrays(*this, visit);
  }

  void resize(std::size_t n) {
    for_each_array([n](const char*, auto& array) { array.resize(n); });
  }
};

}  // namespace snowshed
