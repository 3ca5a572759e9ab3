// Text inside XML attributes.
#pragma once

#include <string>
#include <string_view>

namespace snowshed {

std::string xml_escape(std::string_view text);

/// The reverse; an entity it does not know stays as it is.
std::string xml_unescape(std::string_view text);

}  // namespace snowshed
