// Converts one JSON value to one C++ value, or throws an InputError that names the given value.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/geometry/polygon.hpp"
#include "snowshed/methods/range.hpp"

namespace snowshed::scene {

/// A value in a message: the scalar itself, or "an object", "an array".
std::string shown(const nlohmann::json& value);

InputError wrong_type(const std::string& path, const nlohmann::json& value,
                      const std::string& allowed);

double to_number(const nlohmann::json& value, const std::string& path, const std::string& allowed);
bool to_flag(const nlohmann::json& value, const std::string& path);
std::string to_text(const nlohmann::json& value, const std::string& path);

/// "an array of 2 numbers (x, z)" in 2D.
std::string vector_text(int dimension);
Vec3 to_vector(const nlohmann::json& value, const std::string& path, int dimension);

/// The corners of an outline: an array of [x, y].
geometry::Ring to_ring(const nlohmann::json& value, const std::string& path);

/// Also takes whole numbers written as 5.0, which are integers in JSON Schema.
template <class Int>
Int to_integer(const nlohmann::json& value, const std::string& path, const methods::Range& range,
               const std::string& allowed) {
  const double number = to_number(value, path, allowed);
  if (std::floor(number) != number) throw wrong_type(path, value, allowed);
  // The check comes before the conversion, which is undefined for numbers that Int cannot hold. The
  // limit itself is not representable as a double for 64 bits; there the next power of two is
  // already too large.
  constexpr Int max_value = std::numeric_limits<Int>::max();
  const bool fits = value.is_number_float()
                        ? number < static_cast<double>(max_value)
                        : number < 0 || value.get<std::uint64_t>() <= std::uint64_t{max_value};
  if (!range.contains(number))
    throw InputError(path, shown(value) + " is outside the allowed range (" + range.text() + ")");
  if (!fits)
    throw InputError(
        path, shown(value) + " is above " + std::to_string(max_value) + ", the largest allowed");
  return value.get<Int>();
}

/// The index of the value among `names`.
std::size_t to_index(const nlohmann::json& value, const std::string& path,
                     const std::vector<std::string>& names);

}  // namespace snowshed::scene
