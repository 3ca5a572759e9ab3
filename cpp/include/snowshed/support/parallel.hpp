// Loops over threads. What an iteration writes is its own, so results never depend on how many
// threads there are or which of them runs what.
#pragma once

#include <omp.h>

#include <cstddef>

#ifdef SNOWSHED_STD_THREADS
#include <thread>
#include <vector>
#endif

namespace snowshed {

#ifdef SNOWSHED_STD_THREADS
/// Stands in for OpenMP where ThreadSanitizer watches, which understands std::thread. Iterations
/// go to the threads in turn, however short the loop, so that any two neighbours that touch the
/// same memory are on different threads.
template <class F>
void run_in_turn(std::ptrdiff_t n, int threads, F& f) {
  const auto share = [&f, n, threads](std::ptrdiff_t thread) {
    for (std::ptrdiff_t i = thread; i < n; i += threads) f(i);
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(share, thread);
  share(0);
  for (std::thread& other : others) other.join();
}
#endif

/// f(i) for i in [0, n); threads take `grain` iterations at a time, as they become free.
template <class F>
void parallel_for(std::ptrdiff_t n, int threads, [[maybe_unused]] int grain, F f) {
#ifdef SNOWSHED_STD_THREADS
  run_in_turn(n, threads, f);
#else
  if (threads == 1 || n <= grain) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
#pragma omp parallel for schedule(dynamic, grain) num_threads(threads)
  for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
#endif
}

/// The same in one equal piece per thread: for many cheap iterations.
template <class F>
void parallel_for_each(std::ptrdiff_t n, int threads, F f) {
#ifdef SNOWSHED_STD_THREADS
  run_in_turn(n, threads, f);
#else
  if (threads == 1 || n < 4096) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
#endif
}

}  // namespace snowshed
