// When is snow at rest?
#pragma once

namespace snowshed {

/// The snow rests when for `rest_time` seconds on end its speed (root of twice the kinetic energy
/// over the mass that the event brought, so that a large stack at rest does not hide a small slab
/// in motion) stays below `rest_speed`, and has not grown meanwhile, because snow that is just
/// setting off is slow, too.
class RestDetector {
 public:
  RestDetector(double rest_speed, double rest_time) : limit_(rest_speed), duration_(rest_time) {}

  void start_event(double time) { since_ = time, speed_at_start_ = 0, speed_ = 0, next_ = time; }

  /// Returns whether the detector needs the speed again.
  bool due(double time) const { return time >= next_; }

  /// Tells the detector the speed (m/s) at a time (s); returns whether the snow rests.
  bool at_rest(double time, double speed);

  /// Speed that was told last, m/s.
  double speed() const { return speed_; }

  /// State for checkpoints.
  struct State {
    double since, speed_at_start, speed, next;
  };
  State state() const { return {since_, speed_at_start_, speed_, next_}; }
  void restore(const State& s) {
    since_ = s.since, speed_at_start_ = s.speed_at_start, speed_ = s.speed, next_ = s.next;
  }

 private:
  double limit_, duration_;
  double since_ = 0;           // start of the present quiet interval
  double speed_at_start_ = 0;  // speed at the start of that interval
  double speed_ = 0, next_ = 0;
};

}  // namespace snowshed
