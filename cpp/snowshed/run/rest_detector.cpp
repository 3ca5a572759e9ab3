#include "snowshed/run/rest_detector.hpp"

#include <algorithm>

namespace snowshed::run {

bool RestDetector::at_rest(double time, double speed) {
  next_ = time + 0.1 * duration_;
  speed_ = speed;
  const bool quiet = speed < limit_;
  const bool growing = speed > std::max(1.05 * speed_at_start_, 0.05 * limit_);
  if (!quiet || growing) {
    since_ = time;
    speed_at_start_ = speed;
    return false;
  }
  return time - since_ >= duration_;
}

}  // namespace snowshed::run
