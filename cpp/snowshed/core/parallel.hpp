// Loops over threads. What an iteration writes is its own, so results never depend on how many
// threads there are or which of them runs what.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

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

#ifndef SNOWSHED_STD_THREADS
/// The part of a loop that belongs to one thread, on a cache line of its own.
struct alignas(64) LoopShare {
  std::atomic<std::ptrdiff_t> next{0};
  std::ptrdiff_t end = 0;
};

inline std::vector<LoopShare> equal_shares(std::ptrdiff_t n, int threads) {
  std::vector<LoopShare> shares(threads);
  for (int t = 0; t < threads; ++t) {
    shares[t].next = n * t / threads;
    shares[t].end = n * (t + 1) / threads;
  }
  return shares;
}
#endif

/// f(i) for i in [0, n); threads take `grain` iterations at a time. Each has its own share of the
/// range, so that it finds in its cache what it left there the last time, and helps with those of
/// the others when it has done its own.
template <class F>
void parallel_for(std::ptrdiff_t n, int threads, [[maybe_unused]] int grain, F f) {
#ifdef SNOWSHED_STD_THREADS
  run_in_turn(n, threads, f);
#else
  if (threads == 1 || n <= grain) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
  std::vector<LoopShare> shares = equal_shares(n, threads);
#pragma omp parallel num_threads(threads)
  for (int k = 0; k < threads; ++k) {
    LoopShare& share = shares[(omp_get_thread_num() + k) % threads];
    std::ptrdiff_t i;
    while ((i = share.next.fetch_add(grain, std::memory_order_relaxed)) < share.end)
      for (const std::ptrdiff_t end = std::min(i + grain, share.end); i < end; ++i) f(i);
  }
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
