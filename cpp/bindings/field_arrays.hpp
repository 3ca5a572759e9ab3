// Fields of particles as NumPy arrays.
#pragma once

#include <pybind11/numpy.h>

#include "snowshed/methods/method.hpp"

namespace snowshed {

/// A read-only array that uses the view's memory and keeps it alive; (n,), (n, 3) or (n, 3, 3).
pybind11::array array_of(const particles::FieldView&);

/// A copy of a field ordered by id, in double precision, or in 64 bits for whole numbers.
pybind11::array array_by_id(const methods::Method&, const std::string& name);

}  // namespace snowshed
