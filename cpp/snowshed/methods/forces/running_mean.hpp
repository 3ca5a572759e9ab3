// The mean of a force over the last moments, and its largest value.
#pragma once

#include <array>

#include "snowshed/core/vec.hpp"

namespace snowshed::methods {

/// The mean force over a window of time that moves on by a twentieth of its length. A step's force
/// counts as constant in the step.
class RunningMean {
 public:
  explicit RunningMean(double window = 1) : window_(window) {}

  double window() const { return window_; }  ///< s
  /// The mean over the last window, or over the part of it that the bins hold, N.
  Vec3 mean() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& bin : bins_) sum += bin;
    return sum / (window_ - window_ / count + filled_);
  }
  /// The mean with the largest norm since the start of the event, N, and the end of its window, s.
  const Vec3& peak() const { return peak_; }
  double peak_time() const { return peak_time_; }

  void begin_event(double time) {
    peak_.setZero();
    peak_time_ = time;
  }

  /// Adds the impulse (N s) of a step of dt seconds that ends at `time`.
  void add(const Vec3& impulse, double time, double dt) noexcept {
    const double length = window_ / count;
    if (!(dt > 0)) return;
    const Vec3 force = impulse / dt;
    // Time long before the end leaves no trace in the bins.
    double rest = dt;
    if (rest > 2 * window_) {
      note(force, time - dt + window_);
      rest = 2 * window_;
    }
    while (rest > 0) {
      const double room = length - filled_, part = rest < room ? rest : room;
      bins_[at_] += part * force;
      filled_ += part;
      rest -= part;
      if (part < room) return;
      note(mean(), time - rest);
      at_ = (at_ + 1) % count;
      bins_[at_].setZero();
      filled_ = 0;
    }
  }

  /// Calls f with each number of the state.
  template <class Self, class F>
  static void for_each_number(Self& self, const F& f) {
    for (auto& bin : self.bins_)
      for (int d = 0; d < 3; ++d) f(bin[d]);
    for (int d = 0; d < 3; ++d) f(self.peak_[d]);
    f(self.at_);
    f(self.filled_);
    f(self.peak_time_);
  }
  bool is_sound() const { return at_ >= 0 && at_ < count && filled_ >= 0 && filled_ <= window_; }

 private:
  static constexpr int count = 20;

  void note(const Vec3& force, double time) {
    if (!(force.squaredNorm() > peak_.squaredNorm())) return;
    peak_ = force;
    peak_time_ = time;
  }

  double window_;  // s
  std::array<Vec3, count> bins_ = filled_with_zeros();  // N s
  int at_ = 0;                                          // the bin that is being filled
  double filled_ = 0;                                   // s, of this bin
  Vec3 peak_ = Vec3::Zero();                            // N
  double peak_time_ = 0;                                // s

  static std::array<Vec3, count> filled_with_zeros() {
    std::array<Vec3, count> bins;
    bins.fill(Vec3::Zero());
    return bins;
  }
};

}  // namespace snowshed::methods
