// A rigid block on a plane: the smallest method, made as docs/develop/add-a-method.md says.
#pragma once

#include "snowshed/methods/allowed.hpp"
#include "snowshed/methods/settings_visitor.hpp"

namespace snowshed::methods::block {

struct Settings {
  double tilt = 30;         // degrees, of the plane; it falls along x
  double friction = 0.2;    // Coulomb coefficient
  double mass = 2;          // kg
  double time_step = 1e-3;  // s
  int threads = 0;          // 0: all

  double resolution() const { return 0.1; }
};

inline void describe(SettingsVisitor& v, Settings& s) {
  v.number("tilt", s.tilt, "degrees", non_negative.below(90.0), "Tilt of the plane");
  v.number("friction", s.friction, "", allowed::coefficient, "Coulomb coefficient");
  v.number("mass", s.mass, "kg", positive.up_to(1e6), "Mass of the block");
  v.number("time_step", s.time_step, "s", positive.up_to(1.0), "Length of a step");
  v.integer("threads", s.threads, non_negative.up_to(4096), "Threads; 0: all");
}

}  // namespace snowshed::methods::block
