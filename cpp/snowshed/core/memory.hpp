// Memory that the process has used and memory of the machine.
#pragma once

#include <cstdint>

namespace snowshed {

/// Largest resident size of this process so far, bytes; 0 if the system does not report it.
std::uint64_t peak_resident_bytes();

/// Memory that this process may use, bytes: the machine's, or the container's limit if it is lower.
std::uint64_t physical_memory_bytes();

/// Memory that is available now without swapping, bytes; never more than `physical_memory_bytes`.
std::uint64_t available_memory_bytes();

}  // namespace snowshed
