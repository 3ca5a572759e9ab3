// Text of XML attributes.
#pragma once

#include <string>
#include <string_view>

namespace snowshed::io {

/// Returns `text` with the five reserved characters replaced by entities.
std::string xml_escape(std::string_view text);

/// Returns `text` with the entities of xml_escape replaced by their characters. Other entities
/// stay.
std::string xml_unescape(std::string_view text);

}  // namespace snowshed::io
