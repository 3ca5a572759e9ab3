// Requests to stop work that takes long.
#pragma once

#include <functional>
#include <stdexcept>

namespace snowshed {

/// A function that long work calls from time to time; if it returns true, the work stops. It may be
/// empty.
using StopRequest = std::function<bool()>;

/// Thrown by work that was stopped. Its data are unchanged.
class Stopped : public std::runtime_error {
 public:
  Stopped() : std::runtime_error("interrupted") {}
};

/// Asks every few thousand turns of a loop, so that asking costs nothing.
class StopCheck {
 public:
  explicit StopCheck(const StopRequest& request) : request_(request) {}

  /// Throws `Stopped` if the work shall stop.
  void operator()() {
    if (++turns_ % turns_between == 0 && request_ && request_()) throw Stopped();
  }

 private:
  static constexpr unsigned turns_between = 4096;

  const StopRequest& request_;
  unsigned turns_ = 0;
};

}  // namespace snowshed
