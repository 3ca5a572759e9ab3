// How messages show numbers, names and places.
#pragma once

#include <string>
#include <vector>

namespace snowshed {

/// The shortest text that reads back as the same number: 0.5, 210, 1e-07.
std::string show(double number);

/// Six digits, for what has been computed.
std::string show_rounded(double number);

/// Text in quotation marks, in ASCII, shortened if long: safe to print whatever it holds.
std::string quote(const std::string& text);

bool is_utf8(const std::string& text);

/// JSON pointer (RFC 6901) of a member or an item. Control characters and the rest of a very long
/// key, which only a broken scene has, are not worth showing.
std::string pointer(const std::string& parent, const std::string& key);

/// `"a", "b", "c"`.
std::string quoted_list(const std::vector<std::string>& names);

/// "; did you mean "x"?" with the name nearest to `given`, or "" if none is near.
std::string suggestion(const std::string& given, const std::vector<std::string>& names);

}  // namespace snowshed
