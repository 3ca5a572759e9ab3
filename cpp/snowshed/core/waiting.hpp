// Waiting for another thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace snowshed {

/// Tells the processor that this thread only waits.
inline void relax_processor() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Lets a thread wait for a condition that another thread brings about: awake for a short time,
/// which costs least while all threads have cores, then asleep. If the other thread has no core, it
/// can then have this thread's core, which a thread that waits awake would keep from it.
///
/// The time awake is learned: it grows by a little with each wait that ended awake, and falls to a
/// fraction when the thread had to sleep. So it is long on a quiet machine, and a few microseconds
/// where other programs take the cores.
class Waiting {
 public:
  template <class Condition>
  void until(Condition condition) {
    while (!wait_awake(condition)) {
      std::unique_lock<std::mutex> lock(mutex_);
      asleep_.store(true);  // before the condition is read; `wake` is called after it is written
      if (!condition()) woken_.wait(lock);
      asleep_.store(false);
    }
  }

  /// Wakes the thread if it sleeps. The condition must have been changed before, by a sequentially
  /// consistent operation.
  void wake() {
    if (!asleep_.load()) return;
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      asleep_.store(false);
    }
    woken_.notify_one();
  }

 private:
  using Microseconds = std::chrono::duration<double, std::micro>;
  static constexpr Microseconds min_patience{2.0}, max_patience{200.0}, growth{0.25};
  static constexpr double share_after_sleep = 0.25;
  static constexpr int looks = 32;  // at the condition between looks at the clock

  template <class Condition>
  bool wait_awake(Condition& condition) {
    const auto begin = std::chrono::steady_clock::now();
    do {
      for (int look = 0; look < looks; ++look) {
        if (condition()) {
          patience_ = std::min(max_patience, patience_ + growth);
          return true;
        }
        relax_processor();
      }
    } while (std::chrono::steady_clock::now() - begin < patience_);
    patience_ = std::max(min_patience, share_after_sleep * patience_);
    return false;
  }

  Microseconds patience_ = max_patience;
  std::atomic<bool> asleep_{false};
  std::mutex mutex_;
  std::condition_variable woken_;
};

}  // namespace snowshed
