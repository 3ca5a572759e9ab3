// Steps of a method until a time.
#pragma once

#include "snowshed/methods/method.hpp"

namespace snowshed::methods {

/// Takes steps until `time` (s) is reached, or none if it has passed. The method chooses the length
/// of its steps, so the last one ends up to a step later. Throws as `Method::step`; the steps
/// before remain taken.
inline void advance_to(Method& method, double time) { method.advance(time); }

}  // namespace snowshed::methods
