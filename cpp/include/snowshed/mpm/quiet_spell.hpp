// How long something has been slow.
#pragma once

#include <algorithm>

namespace snowshed {

/// A stretch of time over which a speed stays below a limit and does not grow: what is just
/// setting off is slow too.
struct QuietSpell {
  double since = 0;        // s
  double start_speed = 0;  // m/s, at `since`

  /// Tells of the speed at a time; returns whether the spell has lasted for `duration`.
  bool lasts(double time, double speed, double limit, double duration) {
    const bool growing = speed > std::max(1.05 * start_speed, 0.05 * limit);
    if (!(speed < limit) || growing) {
      since = time;
      start_speed = speed;
      return false;
    }
    return time - since >= duration;
  }
};

}  // namespace snowshed
