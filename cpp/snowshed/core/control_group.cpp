#include "snowshed/core/control_group.hpp"

#include <fstream>
#include <sstream>

namespace snowshed {
namespace {

namespace fs = std::filesystem;

/// Whether a line "number:controllers:group" of /proc/self/cgroup is that of a controller, which
/// may share its tree with others. The line of version 2 names none.
bool names(const std::string& controllers, ControlGroups version, const std::string& controller) {
  if (version == ControlGroups::version2) return controllers.empty();
  return ("," + controllers + ",").find("," + controller + ",") != std::string::npos;
}

}  // namespace

std::vector<fs::path> control_group_folders(ControlGroups version, const std::string& controller,
                                            const fs::path& root) {
  const fs::path top = root / "sys/fs/cgroup" /
                       (version == ControlGroups::version2 ? fs::path() : fs::path(controller));
  fs::path group;
  std::ifstream lines(root / "proc/self/cgroup");
  for (std::string line, number, controllers, path; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::getline(std::getline(fields, number, ':'), controllers, ':');
    std::getline(fields, path);
    if (names(controllers, version, controller)) group = fs::path(path).relative_path();
  }
  std::vector<fs::path> folders;
  for (; !group.empty(); group = group.parent_path()) folders.push_back(top / group);
  folders.push_back(top);
  return folders;
}

}  // namespace snowshed
