// How many threads take a short step: as many as make it faster, which only a trial can tell.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

namespace snowshed {

/// Tries now and then whether steps are faster with one thread or with many, and goes on with what
/// was faster. Threads that share few microseconds of work, or their cores with other programs,
/// wait longer for each other than they save. For steps whose results do not depend on it.
class ThreadChoice {
 public:
  /// Returns the number of threads for the step that begins, 1 or `most`.
  int begin(int most) {
    if (most == 1) return 1;
    const std::size_t step = steps_++ % period;
    trial_ = step < 2 * trials;
    if (!trial_) return many_ ? most : 1;
    slot_ = step;
    begin_ = Clock::now();
    return step % 2 == 0 ? 1 : most;
  }

  /// To be called after each step that `begin` was called for.
  void end() {
    if (!trial_) return;
    seconds_[slot_ % 2][slot_ / 2] = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (slot_ + 1 == 2 * trials) many_ = median(seconds_[1]) < worthwhile * median(seconds_[0]);
    trial_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t period = 1024, trials = 9;  // steps
  static constexpr double worthwhile = 0.9;                // of the time with one thread
  using Times = std::array<double, trials>;

  static double median(Times times) {
    std::nth_element(times.begin(), times.begin() + trials / 2, times.end());
    return times[trials / 2];
  }

  std::size_t steps_ = 0, slot_ = 0;
  bool trial_ = false, many_ = false;
  Clock::time_point begin_;
  std::array<Times, 2> seconds_{};  // of the trials, s: with one thread and with many
};

}  // namespace snowshed
