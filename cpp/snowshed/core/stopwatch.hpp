// Wall-clock time.
#pragma once

#include <chrono>

namespace snowshed {

/// A clock that starts at its construction.
class Stopwatch {
 public:
  /// Seconds since construction or the last `restart`.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// Starts again from zero; returns the seconds until now.
  double restart() {
    const Clock::time_point now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace snowshed
