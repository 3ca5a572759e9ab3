#include "snowshed/methods/mpm/describe.hpp"

#include "snowshed/methods/allowed.hpp"

namespace snowshed::mpm {

void describe(SettingsVisitor& v, Settings& n) {
  v.accuracy({"dx", "precision", "transfer", "flip_ratio", "damping_rate", "basis",
              "courant_factor", "strain_limit", "sleep_speed", "sleep_time"});
  v.alias("courant_factor", "step_factor");  // its name up to version 0.1
  v.number("dx", n.dx, "m", allowed::size, "Size of grid cells and voxels");
  v.choice("precision", n.precision, "Floating-point type of the particles and the grid");
  v.choice("transfer", n.transfer, "Transfer of velocities between particles and grid");
  v.number(
      "flip_ratio", n.flip_ratio, "", fraction,
      "Share of FLIP in FLIP/PIC in each step, so that shorter steps damp more; 0 is pure PIC");
  v.number_instead("damping_rate", n.damping_rate, "flip_ratio", "1/s", non_negative.up_to(1e9),
                   "In place of flip_ratio: rate of the damping by PIC, whatever the step");
  v.choice("basis", n.basis, "B-spline of the grid");
  v.number("courant_factor", n.courant_factor, "", positive.up_to(1.0),
           "Time step over the largest stable one");
  v.number("strain_limit", n.strain_limit, "", positive.up_to(0.5),
           "Largest |dt grad v| that a step may impose on a particle");
  v.number("sleep_speed", n.sleep_speed, "m/s", non_negative.up_to(1e4),
           "Snow slower than this drops out of the steps until something moves it; 0: never");
  v.number("sleep_time", n.sleep_time, "s", allowed::time,
           "Duration for which it must have been slower without speeding up");
  v.integer("threads", n.threads, non_negative.up_to(4096), "Threads; 0: all");
}

}  // namespace snowshed::mpm
