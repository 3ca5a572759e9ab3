// Loops over threads. What an iteration writes is its own, so results never depend on how many
// threads there are or which of them runs what.
#pragma once

#include <omp.h>

#include <cstddef>

namespace snowshed {

/// f(i) for i in [0, n); threads take `grain` iterations at a time, as they become free.
template <class F>
void parallel_for(std::ptrdiff_t n, int threads, int grain, F f) {
  if (threads == 1 || n <= grain) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
#pragma omp parallel for schedule(dynamic, grain) num_threads(threads)
  for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
}

/// The same in one equal piece per thread: for many cheap iterations.
template <class F>
void parallel_for_each(std::ptrdiff_t n, int threads, F f) {
  if (threads == 1 || n < 4096) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
}

}  // namespace snowshed
