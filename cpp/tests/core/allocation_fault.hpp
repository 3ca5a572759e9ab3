// Lets an allocation fail, to see what becomes of the state of whoever asked for memory.
#pragma once

#include <cstdint>

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

}  // namespace snowshed
