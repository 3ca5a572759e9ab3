// Loops over threads. Each iteration writes only its own data, so results never depend on the
// number of threads or on their shares of the work. If iterations throw, the loop throws the
// exception of the first of them (by index); later iterations may have run before.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

namespace snowshed {

/// The number of threads for a run: the given number, or with 0 as many as OpenMP would start,
/// which is OMP_NUM_THREADS or else all cores.
inline int threads_to_use(int wanted) { return wanted > 0 ? wanted : omp_get_max_threads(); }

/// The number of threads for a step: at most `max_threads`, and fewer if each would get fewer than
/// `share` items.
inline int threads_for(std::size_t items, std::size_t share, int max_threads) {
  return int(std::clamp<std::size_t>(items / share, 1, std::size_t(max_threads)));
}

/// Keeps the exception of the first iteration (by index) that threw on any thread. An exception
/// that left a parallel region would end the process.
class FirstException {
 public:
  void keep(std::ptrdiff_t iteration) noexcept {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (iteration >= iteration_) return;
    iteration_ = iteration;
    exception_ = std::current_exception();
  }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::ptrdiff_t iteration_ = std::numeric_limits<std::ptrdiff_t>::max();
  std::exception_ptr exception_;
};

/// Calls f(i) for i in [begin, end), a part of a loop that other threads share; ends at the first
/// call that throws.
template <class F>
void run_piece(std::ptrdiff_t begin, std::ptrdiff_t end, std::ptrdiff_t stride, F& f,
               FirstException& thrown) noexcept {
  std::ptrdiff_t i = begin;
  try {
    for (; i < end; i += stride) f(i);
  } catch (...) {
    thrown.keep(i);
  }
}

#ifdef SNOWSHED_STD_THREADS
/// Replaces OpenMP under ThreadSanitizer, which only understands std::thread. Iterations go to the
/// threads in turn, however short the loop, so that any two neighbours that touch the same memory
/// are on different threads.
template <class F>
void run_in_turn(std::ptrdiff_t n, int threads, F& f) {
  FirstException thrown;
  const auto share = [&](std::ptrdiff_t thread) { run_piece(thread, n, threads, f, thrown); };
  std::vector<std::thread> others;
  others.reserve(threads);
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(share, thread);
  share(0);
  for (std::thread& other : others) other.join();
  thrown.rethrow();
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

/// Calls f(i) for i in [0, n); threads take `grain` iterations at a time. Each thread begins with
/// its own share of the range, whose data the last loop left in its cache, and then helps with the
/// shares of the others. If memory for the shares is short, throws before the first iteration.
template <class F>
void parallel_for_dynamic(std::ptrdiff_t n, int threads, [[maybe_unused]] int grain, F f) {
#ifdef SNOWSHED_STD_THREADS
  run_in_turn(n, threads, f);
#else
  if (threads == 1 || n <= grain) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
  std::vector<LoopShare> shares = equal_shares(n, threads);
  FirstException thrown;
#pragma omp parallel num_threads(threads)
  for (int k = 0; k < threads; ++k) {
    LoopShare& share = shares[(omp_get_thread_num() + k) % threads];
    std::ptrdiff_t i;
    while ((i = share.next.fetch_add(grain, std::memory_order_relaxed)) < share.end)
      run_piece(i, std::min(i + grain, share.end), 1, f, thrown);
  }
  thrown.rethrow();
#endif
}

/// The same in one equal piece per thread: for many cheap iterations. Allocates nothing.
template <class F>
void parallel_for_static(std::ptrdiff_t n, int threads, F f) {
#ifdef SNOWSHED_STD_THREADS
  run_in_turn(n, threads, f);
#else
  if (threads == 1 || n < 4096) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
  FirstException thrown;
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int t = 0; t < threads; ++t) run_piece(n * t / threads, n * (t + 1) / threads, 1, f, thrown);
  thrown.rethrow();
#endif
}

/// Calls f(begin, end) for pieces of at most `piece` iterations each. The pieces do not depend on
/// the number of threads. f must not throw. Allocates nothing.
template <class F>
void parallel_pieces(std::ptrdiff_t n, int threads, std::ptrdiff_t piece, F f) {
  const std::ptrdiff_t pieces = (n + piece - 1) / piece;
  const auto run = [&](std::ptrdiff_t p) { f(p * piece, std::min(n, (p + 1) * piece)); };
#ifdef SNOWSHED_STD_THREADS
  run_in_turn(pieces, threads, run);
#else
  if (threads == 1 || pieces <= 1) {
    for (std::ptrdiff_t p = 0; p < pieces; ++p) run(p);
    return;
  }
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::ptrdiff_t p = 0; p < pieces; ++p) run(p);
#endif
}

/// A loop in pieces, see `parallel_pieces`.
template <class F>
struct PieceLoop {
  std::ptrdiff_t n, piece;
  F f;

  std::ptrdiff_t pieces() const { return (n + piece - 1) / piece; }
  void run(std::ptrdiff_t p) { f(p * piece, std::min(n, (p + 1) * piece)); }
};
template <class F>
PieceLoop(std::ptrdiff_t, std::ptrdiff_t, F) -> PieceLoop<F>;

/// The pieces of two loops that do not depend on each other: no thread waits between them.
template <class F, class G>
void parallel_pieces(int threads, PieceLoop<F> first, PieceLoop<G> second) {
  const std::ptrdiff_t m = first.pieces(), n = second.pieces();
#ifdef SNOWSHED_STD_THREADS
  const auto run = [&](std::ptrdiff_t p) { p < m ? first.run(p) : second.run(p - m); };
  run_in_turn(m + n, threads, run);
#else
  if (threads == 1 || m + n <= 1) {
    for (std::ptrdiff_t p = 0; p < m; ++p) first.run(p);
    for (std::ptrdiff_t p = 0; p < n; ++p) second.run(p);
    return;
  }
#pragma omp parallel num_threads(threads)
  {
#pragma omp for schedule(static) nowait
    for (std::ptrdiff_t p = 0; p < m; ++p) first.run(p);
#pragma omp for schedule(static)
    for (std::ptrdiff_t p = 0; p < n; ++p) second.run(p);
  }
#endif
}

}  // namespace snowshed
