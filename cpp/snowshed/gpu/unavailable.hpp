// The error of a machine on which no kernel can run.
#pragma once

#include <string>

#include "snowshed/core/errors.hpp"

namespace snowshed::gpu {

/// No kernel can run on this machine. The message says what is missing, and how to mend it.
class Unavailable : public InputError {
 public:
  explicit Unavailable(const std::string& what) : InputError("", what) {}
};

}  // namespace snowshed::gpu
