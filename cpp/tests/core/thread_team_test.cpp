#include "snowshed/core/thread_team.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "snowshed/core/parallel.hpp"

namespace snowshed {
namespace {

constexpr std::chrono::milliseconds pause{200};

int sum_of_loop(int n, int threads) {
  std::vector<int> values(n);
  parallel_for_dynamic(n, threads, 1, [&](std::ptrdiff_t i) { values[i] = int(i); });
  int sum = 0;
  for (const int value : values) sum += value;
  return sum;
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Calls f on each of so many threads, once all of them are at work.
template <class F>
void run_together(int threads, F f) {
  std::atomic<int> present{0};
  parallel_for_dynamic(threads, threads, 1, [&](std::ptrdiff_t) {
    ++present;
    while (present < threads) std::this_thread::yield();
    f();
  });
}

TEST(ThreadTeam, OtherThreadsTakePart) {
  std::atomic<int> calls{0};
  run_together(2, [&] { ++calls; });
  EXPECT_EQ(calls, 2);
}

TEST(ThreadTeam, ThreadsThatWaitForLongSleepAndComeBack) {
  EXPECT_EQ(sum_of_loop(100, 3), 4950);
  const double before = processor_seconds();
  std::this_thread::sleep_for(pause);
  EXPECT_LT(processor_seconds() - before, 0.1);
  std::atomic<int> calls{0};
  run_together(3, [&] { ++calls; });
  EXPECT_EQ(calls, 3);
}

TEST(ThreadTeam, TheCallerSleepsWhileItWaits) {
  const double before = processor_seconds();
  const std::thread::id caller = std::this_thread::get_id();
  run_together(2, [&] {
    if (std::this_thread::get_id() != caller) std::this_thread::sleep_for(pause);
  });
  EXPECT_LT(processor_seconds() - before, 0.1);
}

TEST(ThreadTeam, ALoopInsideALoopRunsOnItsThread) {
  std::vector<int> sums(8);
  parallel_for_dynamic(8, 2, 1, [&](std::ptrdiff_t i) { sums[i] = sum_of_loop(int(i) + 1, 2); });
  for (int i = 0; i < 8; ++i) EXPECT_EQ(sums[i], i * (i + 1) / 2);
  EXPECT_FALSE(is_in_shared_loop());
}

TEST(ThreadTeam, EachCallingThreadHasItsOwn) {
  std::vector<std::thread> callers;
  std::vector<int> sums(4);
  for (int c = 0; c < 4; ++c)
    callers.emplace_back([&sums, c] {
      for (int repeat = 0; repeat < 50; ++repeat) sums[c] += sum_of_loop(100, 3);
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(sums, std::vector<int>(4, 50 * 4950));
}

TEST(ThreadTeam, GrowsAndShrinksWithItsLoops) {
  for (const int threads : {2, 5, 1, 3, 8, 2}) EXPECT_EQ(sum_of_loop(1000, threads), 499500);
}

// The child of a fork has no other threads; it must not wait for those of its parent.
TEST(ThreadTeam, AForkedProcessHasANewTeam) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer knows no threads after a fork";
#endif
  EXPECT_EQ(sum_of_loop(100, 3), 4950);
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    std::exit(sum_of_loop(100, 3) == 4950 ? 0 : 1);  // also ends the team
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(sum_of_loop(100, 3), 4950);
}

}  // namespace
}  // namespace snowshed
