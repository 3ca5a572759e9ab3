// Settings that other settings, or parts of the scene, leave without effect.
#pragma once

#include <string>
#include <vector>

namespace snowshed::methods {

struct UnusedSettings {
  bool applies;
  std::string because;  // continues "is not used, because"
  std::vector<const char*> settings;
};

}  // namespace snowshed::methods
