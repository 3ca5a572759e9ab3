#include "snowshed/core/thread_team.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <system_error>
#include <thread>
#include <vector>

#ifndef _WIN32
#include <pthread.h>
#include <signal.h>
#endif

#include "snowshed/core/waiting.hpp"

namespace snowshed {
namespace {

#ifdef SNOWSHED_IN_TURN
// For ThreadSanitizer: any two neighbouring iterations run on different threads, in short loops
// too.
constexpr bool in_turn = true;
#else
constexpr bool in_turn = false;
#endif

thread_local bool at_work = false;

/// The threads that share the loops of the calling thread, which is member 0.
class ThreadTeam {
 public:
  ThreadTeam() = default;
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  void run(std::ptrdiff_t n, std::ptrdiff_t grain, int threads, LoopPiece piece, void* loop);

 private:
  enum class Offer { none, loop, end };

  /// Another thread of the team.
  struct alignas(64) Member {
    std::atomic<Offer> offer{Offer::none};
    Waiting waiting;
    std::thread thread;
  };

  /// The iterations that belong to one member.
  struct alignas(64) Share {
    std::atomic<std::ptrdiff_t> next{0};
    std::ptrdiff_t end = 0;
  };

  int gather(int threads);
  void serve(Member& other, int member);
  void work(int member);
  void take_back_offers();

  std::vector<std::unique_ptr<Member>> others_;  // member i + 1
  std::vector<Share> shares_;                    // for each member
  // The loop that is shared now.
  int members_ = 1;
  std::ptrdiff_t grain_ = 1;
  LoopPiece piece_ = nullptr;
  void* loop_ = nullptr;

  alignas(64) std::atomic<int> unfinished_{0};  // offers that others have taken or may still take
  Waiting caller_;
};

thread_local std::unique_ptr<ThreadTeam> team;

#ifdef _WIN32
struct BlockedSignals {};
void prepare_for_forks() {}
#else
/// Blocks all signals while it lives, also for threads started meanwhile. So the team's threads
/// never run the signal handlers of the program.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_;
};

/// Threads do not survive a fork. The child keeps the memory of the team, because it cannot end
/// threads that it does not have.
void forget_team() {
  (void)team.release();
  at_work = false;
}

void prepare_for_forks() {
  static const int registered = pthread_atfork(nullptr, nullptr, forget_team);
  (void)registered;
}
#endif

ThreadTeam::~ThreadTeam() {
  for (const auto& other : others_) {
    other->offer.store(Offer::end);
    other->waiting.wake();
  }
  for (const auto& other : others_) other->thread.join();
}

void ThreadTeam::run(std::ptrdiff_t n, std::ptrdiff_t grain, int threads, LoopPiece piece,
                     void* loop) {
  members_ = gather(threads);
  grain_ = grain;
  piece_ = piece;
  loop_ = loop;
  for (int m = 0; m < members_; ++m) {
    shares_[m].next.store(n * m / members_, std::memory_order_relaxed);
    shares_[m].end = in_turn ? n : n * (m + 1) / members_;
  }
  unfinished_.store(members_ - 1);
  for (int m = 1; m < members_; ++m) others_[m - 1]->offer.store(Offer::loop);
  for (int m = 1; m < members_; ++m) others_[m - 1]->waiting.wake();

  at_work = true;
  work(0);
  at_work = false;

  if (!in_turn) take_back_offers();
  caller_.until([this] { return unfinished_.load() == 0; });
}

/// Returns the number of members that can work: `threads`, or fewer if the system starts no more.
int ThreadTeam::gather(int threads) {
  if (int(shares_.size()) < threads) shares_ = std::vector<Share>(threads);
  if (int(others_.size()) >= threads - 1) return threads;
  const BlockedSignals blocked;
  others_.reserve(threads - 1);
  while (int(others_.size()) < threads - 1) {
    auto other = std::make_unique<Member>();
    const int member = int(others_.size()) + 1;
    try {
      other->thread = std::thread([this, member, &o = *other] { serve(o, member); });
    } catch (const std::system_error&) {
      break;
    }
    others_.push_back(std::move(other));
  }
  return int(others_.size()) + 1;
}

void ThreadTeam::take_back_offers() {
  int taken_back = 0;
  for (int m = 1; m < members_; ++m) {
    Offer offer = Offer::loop;
    taken_back += others_[m - 1]->offer.compare_exchange_strong(offer, Offer::none);
  }
  unfinished_.fetch_sub(taken_back);
}

/// The life of another thread.
void ThreadTeam::serve(Member& other, int member) {
  at_work = true;
  while (true) {
    other.waiting.until([&] { return other.offer.load() != Offer::none; });
    Offer offer = Offer::loop;
    if (other.offer.compare_exchange_strong(offer, Offer::none)) {
      work(member);
      if (unfinished_.fetch_sub(1) == 1) caller_.wake();
    } else if (offer == Offer::end) {
      return;
    }
  }
}

/// The part of a member in the loop that is shared now.
void ThreadTeam::work(int member) {
  if (in_turn) {
    for (std::ptrdiff_t i = member; i < shares_[member].end; i += members_) piece_(loop_, i, i + 1);
    return;
  }
  for (int k = 0; k < members_; ++k) {
    Share& share = shares_[(member + k) % members_];
    std::ptrdiff_t i;
    while ((i = share.next.fetch_add(grain_, std::memory_order_relaxed)) < share.end)
      piece_(loop_, i, std::min(i + grain_, share.end));
  }
}

}  // namespace

void share_loop(std::ptrdiff_t n, std::ptrdiff_t grain, int threads, LoopPiece piece, void* loop) {
  if (!team) {
    prepare_for_forks();
    team = std::make_unique<ThreadTeam>();
  }
  team->run(n, grain, threads, piece, loop);
}

bool is_in_shared_loop() { return at_work; }

}  // namespace snowshed
