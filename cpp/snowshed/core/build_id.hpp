// The build of the library: the sources it was made of, and the compiler.
#pragma once

#include <string>

namespace snowshed {

/// A digest of the sources in cpp/snowshed, 12 hexadecimal digits.
const char* build_id();

/// The commit as `git describe` shows it, with "-dirty" after changes; empty without git.
const char* build_commit();

/// The compiler and its version, "GCC 12.2.0".
std::string compiler_name();

}  // namespace snowshed
