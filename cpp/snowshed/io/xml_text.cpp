#include "snowshed/io/xml_text.hpp"

#include <utility>

namespace snowshed::io {
namespace {

constexpr std::pair<char, std::string_view> entities[] = {
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}};

}  // namespace

std::string xml_escape(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    std::string_view replacement(&c, 1);
    for (const auto& [character, entity] : entities)
      if (c == character) replacement = entity;
    escaped += replacement;
  }
  return escaped;
}

std::string xml_unescape(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    char c = text.front();
    std::size_t length = 1;
    for (const auto& [character, entity] : entities)
      if (text.substr(0, entity.size()) == entity) {
        c = character;
        length = entity.size();
      }
    plain += c;
    text.remove_prefix(length);
  }
  return plain;
}

}  // namespace snowshed::io
