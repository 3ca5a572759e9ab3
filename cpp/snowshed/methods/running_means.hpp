// Means of a force over windows of time, and their largest values.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "snowshed/core/vec.hpp"

namespace snowshed::methods {

/// The mean force over the last 1, 10 and 100 ms. The windows move on by bins of 0.1 ms. A step's
/// force counts as constant in the step.
class RunningMeans {
 public:
  static constexpr double bin = 1e-4;                          // s
  static constexpr std::array<int, 3> windows{10, 100, 1000};  // bins

  /// The length of a window, s.
  static constexpr double window(std::size_t k) { return windows[k] * bin; }
  /// The mean over the last window, N.
  Vec3 mean(std::size_t k) const { return sums_[k] * (1 / window(k)); }
  /// The mean with the largest norm since the start of the event, N, and the end of its window, s.
  const Vec3& peak(std::size_t k) const { return peaks_[k]; }
  double peak_time(std::size_t k) const { return peak_times_[k]; }

  void begin_event(double time) noexcept {
    peaks_.fill(Vec3::Zero());
    peak_times_.fill(time);
  }

  /// Adds the impulse (N s) of a step of dt seconds that ends at `time`.
  void add(const Vec3& impulse, double time, double dt) noexcept {
    if (!(dt > 0)) return;
    const Vec3 force = impulse / dt;
    constexpr double max_rest = 2 * windows[2] * bin;
    double rest = dt;
    if (rest > max_rest) {  // only the peak remembers the time before
      for (std::size_t k = 0; k < 3; ++k) note(k, force, time - dt + window(k));
      rest = max_rest;
    }
    while (rest >= bin - filled_) {
      rest -= bin - filled_;
      push(current_ + (bin - filled_) * force, time - rest);
      current_.setZero();
      filled_ = 0;
    }
    current_ += rest * force;
    filled_ += rest;
  }

  /// Calls f with each number of the state.
  template <class Self, class F>
  static void for_each_number(Self& self, const F& f) {
    const auto each = [&f](auto& vectors) {
      for (auto& v : vectors)
        for (int d = 0; d < 3; ++d) f(v[d]);
    };
    each(self.bins_);
    each(self.sums_);
    each(self.peaks_);
    for (auto& time : self.peak_times_) f(time);
    for (int d = 0; d < 3; ++d) f(self.current_[d]);
    f(self.filled_);
    f(self.at_);
  }
  bool is_sound() const { return at_ >= 0 && at_ < windows[2] && filled_ >= 0 && filled_ <= bin; }

 private:
  /// Ends a bin with its impulse.
  void push(const Vec3& impulse, double time) noexcept {
    constexpr int count = windows[2];
    for (std::size_t k = 0; k < 3; ++k) {
      const int left = at_ >= windows[k] ? at_ - windows[k] : at_ - windows[k] + count;
      sums_[k] += impulse - bins_[std::size_t(left)];
      note(k, mean(k), time);
    }
    bins_[std::size_t(at_)] = impulse;
    at_ = (at_ + 1) % count;
  }
  void note(std::size_t k, const Vec3& force, double time) noexcept {
    if (!(force.squaredNorm() > peaks_[k].squaredNorm())) return;
    peaks_[k] = force;
    peak_times_[k] = time;
  }
  static std::array<Vec3, 3> zeros() {
    std::array<Vec3, 3> vectors;
    vectors.fill(Vec3::Zero());
    return vectors;
  }

  std::vector<Vec3> bins_ = std::vector<Vec3>(windows[2], Vec3::Zero());  // N s
  std::array<Vec3, 3> sums_ = zeros();                                    // N s, over each window
  std::array<Vec3, 3> peaks_ = zeros();                                   // N
  std::array<double, 3> peak_times_{};                                    // s
  Vec3 current_ = Vec3::Zero();  // N s, of the bin that is being filled
  double filled_ = 0;            // s, of this bin
  int at_ = 0;                   // place of the next bin
};

}  // namespace snowshed::methods
