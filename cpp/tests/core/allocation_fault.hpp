// Makes an allocation fail, to test the state of the caller afterwards.
#pragma once

#include <cstdint>
#include <functional>

namespace snowshed {

/// During its lifetime the n-th call of `operator new` on any thread throws std::bad_alloc; other
/// calls do not. Only one such object may exist at a time.
class AllocationFault {
 public:
  explicit AllocationFault(std::int64_t n);
  ~AllocationFault();
  AllocationFault(const AllocationFault&) = delete;
  AllocationFault& operator=(const AllocationFault&) = delete;

  /// Whether the n-th call was made.
  static bool happened();
};

enum class FaultOutcome { no_fault, failed, recovered };

/// Makes a call during which the n-th allocation fails. The call may end before that allocation,
/// throw std::bad_alloc, or recover from the failure.
FaultOutcome with_allocation_fault(std::int64_t n, const std::function<void()>& call);

}  // namespace snowshed
