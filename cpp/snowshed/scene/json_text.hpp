// A JSON value from untrusted text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace snowshed::scene {

inline constexpr std::size_t max_text_bytes = 64u << 20;
inline constexpr std::size_t max_depth = 64;
inline constexpr std::size_t max_values = 1'000'000;  // else 64 MB of "[[],[],..." fill gigabytes

/// Throws InputError at "name:line:column" on a syntax error, at the JSON pointer on duplicate
/// keys, on numbers too large for a double, and if the text exceeds a limit above.
nlohmann::json parse_json(const std::string& text, const std::string& name);

/// Throws InputError if a text's checksum differs from the one that it contains, as written by
/// `sealed_text`.
void check_seal(const std::string& text, const std::string& name);

/// The indented text of an object, with its checksum (CRC-32) behind its last value.
std::string sealed_text(const nlohmann::ordered_json& object);

/// Indented text; arrays of plain values stay on one line.
std::string indented_text(const nlohmann::ordered_json& value);

}  // namespace snowshed::scene
