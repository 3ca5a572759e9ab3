// Keeps two threads from using one object at once: Python lets other threads run while a call
// computes.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace snowshed {

/// An object together with the call that uses it now.
template <class T>
class Guarded {
 public:
  enum class Access { read, change };

  explicit Guarded(T object) : object_(std::move(object)) {}

  /// Calls f(object). Throws std::runtime_error, and leaves the object alone, while a call of
  /// another thread runs. Calls from within a call of the same thread may only read.
  template <class F>
  auto use(const char* call, Access access, F f) {
    const Use use(*this, call, access);
    return f(object_);
  }

 private:
  class Use {
   public:
    Use(Guarded& guarded, const char* call, Access access) : guarded_(guarded) {
      std::thread::id user;
      outermost_ = guarded_.user_.compare_exchange_strong(user, std::this_thread::get_id());
      const char* under_way = guarded_.call_;
      if (outermost_)
        guarded_.call_ = call;
      else if (user != std::this_thread::get_id())
        throw std::runtime_error(std::string(call) + ": another thread is using this simulation (" +
                                 under_way + "); only one may at a time");
      else if (access == Access::change)
        throw std::runtime_error(std::string(call) + ": called from within " + under_way +
                                 ", whose callback may read the simulation but not change it");
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use() {
      if (outermost_) guarded_.user_ = std::thread::id();
    }

   private:
    Guarded& guarded_;
    bool outermost_;
  };

  T object_;
  std::atomic<std::thread::id> user_{};  // thread that uses the object; default value if free
  std::atomic<const char*> call_{"a call"};
};

}  // namespace snowshed
