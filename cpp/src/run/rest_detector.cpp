#include "snowshed/run/rest_detector.hpp"

namespace snowshed {

bool RestDetector::at_rest(double time, double speed) {
  next_ = time + 0.1 * duration_;
  speed_ = speed;
  return spell_.lasts(time, speed, limit_, duration_);
}

}  // namespace snowshed
