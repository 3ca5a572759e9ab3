#include "snowshed/io/home_folder.hpp"

#include <cstdlib>

namespace snowshed::io {

std::string with_home(const std::string& name) {
  const bool begins = name == "~" || name.rfind("~/", 0) == 0;
  const char* home = begins ? std::getenv("HOME") : nullptr;
  return home && *home ? home + name.substr(1) : name;
}

}  // namespace snowshed::io
