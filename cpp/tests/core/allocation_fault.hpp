// Makes an allocation fail, to test the state of the caller afterwards.
#pragma once

#include <cstdint>
#include <functional>

namespace snowshed {

/// While it lives, the n-th call of `operator new` from its making on, on any thread, throws
/// std::bad_alloc; those before and after do not. One at a time.
class AllocationFault {
 public:
  explicit AllocationFault(std::int64_t n);
  ~AllocationFault();
  AllocationFault(const AllocationFault&) = delete;
  AllocationFault& operator=(const AllocationFault&) = delete;

  /// Whether the n-th call has come.
  static bool happened();
};

enum class FaultOutcome { no_fault, failed, done_without };

/// Makes a call during which the n-th allocation fails. It may not come so far, throw
/// std::bad_alloc, or do without the memory.
FaultOutcome with_allocation_fault(std::int64_t n, const std::function<void()>& call);

}  // namespace snowshed
