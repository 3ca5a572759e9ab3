// Copies of a method's fields, ordered by id.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/method.hpp"

namespace snowshed::methods {

bool has_field(const Method& method, const std::string& name);

/// The values of a field in double precision, those of a particle with several components one after
/// the other. Throws InputError if there is no such field.
std::vector<double> values_by_id(const Method& method, const std::string& name);

}  // namespace snowshed::methods
