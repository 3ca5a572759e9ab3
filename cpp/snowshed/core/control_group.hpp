// The control groups of this process, by which Linux limits containers and batch jobs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace snowshed {

/// The two forms of control groups: one tree for all controllers, or one for each.
enum class ControlGroups { version1, version2 };

/// The folders of the group of this process and of the groups above it, from below. A limit of any
/// of them holds. `controller` is "cpu" or "memory"; `root` stands before the system's paths.
std::vector<std::filesystem::path> control_group_folders(ControlGroups version,
                                                         const std::string& controller,
                                                         const std::filesystem::path& root = "/");

}  // namespace snowshed
