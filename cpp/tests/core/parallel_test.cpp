#include "snowshed/core/parallel.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace snowshed {
namespace {

TEST(Parallel, EveryIterationRunsOnce) {
  for (const int threads : {1, 2, 5})
    for (const std::ptrdiff_t n : {0, 1, 3, 64, 5000}) {
      std::vector<int> runs(std::size_t(n), 0);
      parallel_for_dynamic(n, threads, 16, [&](std::ptrdiff_t i) { ++runs[std::size_t(i)]; });
      parallel_for_static(n, threads, [&](std::ptrdiff_t i) { ++runs[std::size_t(i)]; });
      const auto run = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) ++runs[std::size_t(i)];
      };
      parallel_pieces(n, threads, 16, run);
      const std::ptrdiff_t first = n / 3;
      parallel_pieces(threads, PieceLoop{first, 5, run},
                      PieceLoop{n - first, 16, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                                  run(first + begin, first + end);
                                }});
      EXPECT_EQ(runs, std::vector<int>(std::size_t(n), 4)) << n << " on " << threads;
    }
}

TEST(Parallel, ThrowsTheErrorOfTheFirstFailingIteration) {
  const auto thrown_by = [](const auto& loop) {
    try {
      loop([](std::ptrdiff_t i) {
        if (i % 1000 == 777) throw std::out_of_range(std::to_string(i));
      });
    } catch (const std::out_of_range& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  for (const int threads : {1, 2, 5})
    for (int attempt = 0; attempt < 20; ++attempt) {
      EXPECT_EQ(thrown_by([&](auto f) { parallel_for_dynamic(5000, threads, 16, f); }), "777");
      EXPECT_EQ(thrown_by([&](auto f) { parallel_for_static(5000, threads, f); }), "777");
    }
}

#ifdef SNOWSHED_IN_TURN
/// Iteration i writes element i and the element before, which is not its own.
void race() {
  std::vector<int> written(100, 0);
  parallel_for_dynamic(100, 2, 1, [&](std::ptrdiff_t i) {
    written[std::size_t(i)] = 1;
    written[std::size_t(i > 0 ? i - 1 : 0)] = 2;
  });
}

/// Two loops that run at once and write to the same elements.
void race_of_loops() {
  std::vector<int> written(100, 0);
  const auto write = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) written[std::size_t(i)] = 1;
  };
  parallel_pieces(2, PieceLoop{33, 11, write}, PieceLoop{33, 11, write});
}

/// ThreadSanitizer must detect races between iterations; otherwise its silence means nothing.
TEST(ParallelDeathTest, ARaceBetweenIterationsIsReported) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr int race_exit_code = 66;  // ThreadSanitizer's exit code
  EXPECT_EXIT((race(), std::exit(0)), testing::ExitedWithCode(race_exit_code), "data race");
  EXPECT_EXIT((race_of_loops(), std::exit(0)), testing::ExitedWithCode(race_exit_code),
              "data race");
}
#endif

}  // namespace
}  // namespace snowshed
