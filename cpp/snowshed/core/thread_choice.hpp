// Chooses the number of threads for short steps by trials.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

namespace snowshed {

/// Tries now and then whether steps are faster with one thread or with many, and uses the faster
/// choice. Threads that share few microseconds of work, or their cores with other programs, wait
/// longer for each other than they save. The results of a step must not depend on the choice.
class ThreadChoice {
 public:
  /// Returns the number of threads for the step that begins, 1 or `max_threads`.
  int begin(int max_threads) {
    if (max_threads == 1) return 1;
    step_ = steps_++;
    if (steps_ == period_) {
      steps_ = 0;
      period_ = std::min(4 * period_, max_period);
    }
    if (step_ == 0) use_many_ = gave_up_ = false;
    is_trial_ = step_ < 2 * trials && !gave_up_;
    if (!is_trial_) return use_many_ ? max_threads : 1;
    begin_ = Clock::now();
    return step_ < trials ? 1 : max_threads;
  }

  /// Ends a step for which `begin` was called.
  void end() {
    if (!is_trial_) return;
    const double spent = std::chrono::duration<double>(Clock::now() - begin_).count();
    seconds_[step_ / trials][step_ % trials] = spent;
    if (step_ + 1 == trials) one_thread_seconds_ = median(seconds_[0]);
    // On cores that other programs use, threads wait long: give up after two trials that took twice
    // the time.
    if (step_ == trials + 1) gave_up_ = std::min(spent, seconds_[1][0]) > 2 * one_thread_seconds_;
    if (step_ + 1 == 2 * trials)
      use_many_ = median(seconds_[1]) < max_time_ratio * one_thread_seconds_;
    is_trial_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  // In steps. The first period is short, because a program that has just started runs slower.
  static constexpr std::size_t first_period = 64, max_period = 1024, trials = 9;
  static constexpr double max_time_ratio = 0.9;  // share of the time with one thread
  using Times = std::array<double, trials>;

  static double median(Times times) {
    std::nth_element(times.begin(), times.begin() + trials / 2, times.end());
    return times[trials / 2];
  }

  std::size_t period_ = first_period;  // number of steps between trials
  // Number of steps begun in this period, and the index of the current step in it.
  std::size_t steps_ = 0, step_ = 0;
  bool is_trial_ = false, use_many_ = false, gave_up_ = false;
  double one_thread_seconds_ = 0;  // time of a step with one thread, s
  Clock::time_point begin_;
  std::array<Times, 2> seconds_{};  // times of the trials, s: with one thread and with many
};

}  // namespace snowshed
