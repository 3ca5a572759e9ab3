#include "snowshed/core/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include "snowshed/core/control_group.hpp"

namespace snowshed {
namespace {

using Bytes = std::optional<std::uint64_t>;

/// The number after `key` in a file of "key number [kB]" lines, such as /proc/meminfo.
Bytes read_field(const std::filesystem::path& file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(key, 0) == 0) {
      const std::size_t digit = line.find_first_of("0123456789", key.size());
      if (digit == std::string::npos) return {};
      return std::stoull(line.substr(digit));
    }
  return {};
}

Bytes field_in_kilobytes(const std::filesystem::path& file, const std::string& key) {
  const Bytes kilobytes = read_field(file, key);
  return kilobytes ? Bytes(*kilobytes * 1024) : Bytes();
}

/// The single number in a file; none if it holds "max".
Bytes read_number(const std::filesystem::path& file) {
  std::uint64_t value;
  return std::ifstream(file) >> value ? Bytes(value) : Bytes();
}

struct Allowance {
  std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t left = std::numeric_limits<std::uint64_t>::max();
};

void restrict_to(Allowance& allowance, Bytes limit, Bytes used, Bytes file_cache) {
  if (!limit) return;
  // The file cache counts as used, but is released on demand.
  const std::uint64_t in_use =
      used.value_or(0) - std::min(used.value_or(0), file_cache.value_or(0));
  allowance.limit = std::min(allowance.limit, *limit);
  allowance.left = std::min(allowance.left, *limit - std::min(*limit, in_use));
}

/// The tightest limit among the process's control group and those above it.
Allowance container_allowance() {
  struct Files {
    ControlGroups version;
    const char *limit, *used, *file_cache;
  };
  const Files of_version[] = {
      {ControlGroups::version2, "memory.max", "memory.current", "inactive_file"},
      {ControlGroups::version1, "memory.limit_in_bytes", "memory.usage_in_bytes",
       "total_inactive_file"}};
  Allowance allowance;
  for (const Files& files : of_version)
    for (const auto& group : control_group_folders(files.version, "memory"))
      restrict_to(allowance, read_number(group / files.limit), read_number(group / files.used),
                  read_field(group / "memory.stat", files.file_cache));
  return allowance;
}

std::uint64_t installed_memory_bytes() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

std::uint64_t peak_resident_bytes() {
  // Unlike getrusage, this does not count the parent's memory from before it started this program.
  if (const Bytes peak = field_in_kilobytes("/proc/self/status", "VmHWM:")) return *peak;
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

std::uint64_t physical_memory_bytes() {
  return std::min(installed_memory_bytes(), container_allowance().limit);
}

std::uint64_t available_memory_bytes() {
  const std::uint64_t machine =
      field_in_kilobytes("/proc/meminfo", "MemAvailable:").value_or(installed_memory_bytes());
  const Allowance container = container_allowance();
  return std::min({machine, container.left, physical_memory_bytes()});
}

}  // namespace snowshed
