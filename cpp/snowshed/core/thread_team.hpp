// The threads that share loops.
#pragma once

#include <cstddef>

namespace snowshed {

/// Iterations `begin` to `end` of a loop. Must not throw.
using LoopPiece = void (*)(void* loop, std::ptrdiff_t begin, std::ptrdiff_t end);

/// Runs n iterations in pieces of at most `grain`, on at most `threads` threads: the calling thread
/// and its team, which starts when it is first needed and ends with the calling thread. If memory
/// is short, throws before the first iteration.
///
/// The loop is offered to the team, not ordered. Each member begins with its own share of the
/// iterations, whose data the last loop left in its cache, and then helps with the shares of the
/// others. When nothing is left to begin, the caller takes the offer back from those who have not
/// come. So a thread that gets no core holds nobody up.
void share_loop(std::ptrdiff_t n, std::ptrdiff_t grain, int threads, LoopPiece piece, void* loop);

/// Whether the calling thread is at work in a shared loop. Loops inside it cannot be shared.
bool is_in_shared_loop();

}  // namespace snowshed
