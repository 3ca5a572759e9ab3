// From untrusted text to a JSON value.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace snowshed {

inline constexpr std::size_t max_text_bytes = 64u << 20;
inline constexpr std::size_t max_depth = 64;
inline constexpr std::size_t max_values = 1'000'000;  // else 64 MB of "[[],[],..." fill gigabytes

/// Throws InputError at "name:line:column" on a syntax error, at the JSON pointer on duplicate
/// keys, on numbers too large for a double and beyond the limits above.
nlohmann::json parse_json(const std::string& text, const std::string& name);

/// Indented text; arrays of plain values stay on one line.
std::string pretty(const nlohmann::ordered_json& value);

}  // namespace snowshed
