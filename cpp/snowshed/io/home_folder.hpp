// The user's home in names of files.
#pragma once

#include <string>

namespace snowshed::io {

/// The name of a file with the user's home in place of a leading "~" or "~/". Any other name stays,
/// and every name where the home is not known.
std::string with_home(const std::string& name);

}  // namespace snowshed::io
