// Decides when snow is at rest.
#pragma once

namespace snowshed::run {

/// The snow rests when its speed has stayed below `rest_speed` for `rest_time` seconds and has not
/// grown during this time, because snow that starts to move is slow, too. The speed is the root of
/// twice the kinetic energy over the mass that the event brought: a large stack at rest thus does
/// not hide a small slab in motion.
class RestDetector {
 public:
  RestDetector(double rest_speed, double rest_time) : limit_(rest_speed), duration_(rest_time) {}

  void start_event(double time) { since_ = time, speed_at_start_ = 0, speed_ = 0, next_ = time; }

  /// Returns whether the detector needs the speed again.
  bool due(double time) const { return time >= next_; }

  /// The time (s) at which it needs the speed again.
  double next() const { return next_; }

  /// Records the speed (m/s) at a time (s); returns whether the snow rests.
  bool at_rest(double time, double speed);

  /// The speed that was recorded last, m/s.
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

}  // namespace snowshed::run
