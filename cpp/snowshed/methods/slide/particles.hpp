// The particles of a slide: columns of snow that move over the ground.
#pragma once

#include <cstddef>
#include <cstdint>

#include "snowshed/core/aligned_vector.hpp"

namespace snowshed::methods::slide {

/// One array for each quantity, all of one length. Positions are given from the south-west node of
/// the terrain.
struct Particles {
  AlignedVector<double> x, y, z;     // m
  AlignedVector<double> ux, uy, uz;  // m/s, along the ground
  AlignedVector<double> mass;        // kg
  AlignedVector<double> fresh_mass;  // kg, of a particle when it is seeded; decides on splitting
  AlignedVector<std::uint32_t> id;
  AlignedVector<std::uint16_t> event;
  AlignedVector<double> rest;  // s, for which each has rested; empty unless it is tracked
  bool tracks_rest = false;

  std::size_t size() const { return x.size(); }

  /// Calls visit(name, array) for each array.
  template <class Self, class Visit>
  static void visit_arrays(Self& self, const Visit& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
    visit("ux", self.ux);
    visit("uy", self.uy);
    visit("uz", self.uz);
    visit("mass", self.mass);
    visit("fresh_mass", self.fresh_mass);
    visit("id", self.id);
    visit("event", self.event);
    if (self.tracks_rest) visit("rest", self.rest);
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

}  // namespace snowshed::methods::slide
