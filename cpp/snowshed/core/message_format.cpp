#include "snowshed/core/message_format.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

namespace snowshed {
namespace {

/// Levenshtein distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// Returns the length in bytes of the UTF-8 character that begins at `at`, and sets its code; 0 if
/// there is no valid one.
std::size_t decode(const std::string& text, std::size_t at, std::uint32_t& code) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(at);
  if (lead < 0x80) return code = lead, 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || at + length > text.size()) return 0;
  code = lead & (0x7Fu >> length);
  for (std::size_t i = at + 1; i < at + length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  return length;
}

/// Returns whether a terminal would take a character for a command or for a change of the direction
/// of writing.
bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
         (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF;
}

}  // namespace

std::string printable(const std::string& message) {
  std::string shown;
  for (std::size_t at = 0; at < message.size();) {
    std::uint32_t code = 0;
    const std::size_t length = decode(message, at, code);
    if (length == 0 || is_control(code))
      shown += code == '\n' && length == 1 ? ' ' : '?';
    else
      shown += message.substr(at, length);
    at += std::max<std::size_t>(length, 1);
  }
  return shown;
}

std::string show(double number) {
  if (std::isnan(number)) return "NaN";
  if (std::isinf(number)) return number > 0 ? "Infinity" : "-Infinity";
  std::string text = nlohmann::json(number).dump();
  if (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
  return text;
}

std::string show_rounded(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  return text;
}

std::string show_briefly(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

std::string quote(const std::string& text) {
  constexpr std::size_t max_length = 60;
  constexpr auto replace = nlohmann::json::error_handler_t::replace;
  const std::string quoted =
      nlohmann::json(text.substr(0, max_length)).dump(-1, ' ', /*ensure_ascii=*/true, replace);
  return text.size() <= max_length ? quoted : quoted + "...";
}

bool is_utf8(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

std::string pointer(const std::string& parent, const std::string& key) {
  constexpr std::size_t max_length = 100;
  std::string path = parent + "/";
  std::size_t length = 0;
  for (const char c : key) {
    // Continues a UTF-8 sequence.
    const bool continues = (static_cast<unsigned char>(c) & 0xC0) == 0x80;
    if (++length > max_length && !continues) return path + "...";
    if (c == '~')
      path += "~0";
    else if (c == '/')
      path += "~1";
    else
      path += static_cast<unsigned char>(c) < ' ' || c == 0x7F ? '?' : c;
  }
  return path;
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + quote(name);
  return list;
}

std::string suggestion(const std::string& given, const std::vector<std::string>& names) {
  std::size_t fewest = 1 + std::clamp<std::size_t>(given.size() / 3, 1, 4);
  const std::string* nearest = nullptr;
  for (const auto& name : names) {
    // Only names of similar length can be near; this also keeps huge keys from costing anything.
    if (std::max(given.size(), name.size()) >= std::min(given.size(), name.size()) + fewest)
      continue;
    const std::size_t distance = edit_distance(given, name);
    if (distance < fewest) {
      fewest = distance;
      nearest = &name;
    }
  }
  return nearest ? "; did you mean " + quote(*nearest) + "?" : "";
}

}  // namespace snowshed
