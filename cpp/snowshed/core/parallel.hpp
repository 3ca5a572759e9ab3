// Loops over threads. Each iteration writes only its own data, so results never depend on the
// number of threads or on their shares of the work. If iterations throw, the loop throws the
// exception of the first of them (by index); later iterations may have run before.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>

#include "snowshed/core/thread_team.hpp"

namespace snowshed {

/// The number of threads for a step: at most `max_threads`, and fewer if each would get fewer than
/// `share` items.
inline int threads_for(std::size_t items, std::size_t share, int max_threads) {
  return int(std::clamp<std::size_t>(items / share, 1, std::size_t(max_threads)));
}

/// Keeps the exception of the first iteration (by index) that threw on any thread.
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

/// Calls f(i) for i in [0, n) on at most `threads` threads, which take `grain` iterations at a
/// time. If memory is short, throws before the first iteration.
template <class F>
void parallel_for_dynamic(std::ptrdiff_t n, int threads, std::ptrdiff_t grain, F f) {
  if (threads == 1 || n <= grain || is_in_shared_loop()) {
    for (std::ptrdiff_t i = 0; i < n; ++i) f(i);
    return;
  }
  struct Loop {
    F& f;
    FirstException thrown;
  } loop{f, {}};
  const auto piece = [](void* of, std::ptrdiff_t i, std::ptrdiff_t end) {
    Loop& l = *static_cast<Loop*>(of);
    try {
      for (; i < end; ++i) l.f(i);
    } catch (...) {
      l.thrown.keep(i);
    }
  };
  const std::ptrdiff_t pieces = (n + grain - 1) / grain;
  const int members = int(std::min<std::ptrdiff_t>(threads, pieces));
  share_loop(n, grain, members, piece, &loop);
  loop.thrown.rethrow();
}

/// The same for many cheap iterations.
template <class F>
void parallel_for_static(std::ptrdiff_t n, int threads, F f) {
  constexpr std::ptrdiff_t min_shared = 4096, grain = 1024;
  parallel_for_dynamic(n, n < min_shared ? 1 : threads, grain, f);
}

/// A loop in pieces of at most `piece` iterations each: calls f(begin, end). The pieces do not
/// depend on the number of threads.
template <class F>
struct PieceLoop {
  std::ptrdiff_t n, piece;
  F f;

  std::ptrdiff_t pieces() const { return (n + piece - 1) / piece; }
  void run(std::ptrdiff_t p) { f(p * piece, std::min(n, (p + 1) * piece)); }
};
template <class F>
PieceLoop(std::ptrdiff_t, std::ptrdiff_t, F) -> PieceLoop<F>;

/// Runs the pieces of a loop, see `PieceLoop`.
template <class F>
void parallel_pieces(std::ptrdiff_t n, int threads, std::ptrdiff_t piece, F f) {
  PieceLoop<F&> loop{n, piece, f};
  parallel_for_dynamic(loop.pieces(), threads, 1, [&](std::ptrdiff_t p) { loop.run(p); });
}

/// The pieces of two loops that do not depend on each other: no thread waits between them.
template <class F, class G>
void parallel_pieces(int threads, PieceLoop<F> first, PieceLoop<G> second) {
  const std::ptrdiff_t m = first.pieces();
  parallel_for_dynamic(m + second.pieces(), threads, 1,
                       [&](std::ptrdiff_t p) { p < m ? first.run(p) : second.run(p - m); });
}

}  // namespace snowshed
