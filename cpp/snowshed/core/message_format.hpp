// Numbers, names and JSON paths as messages show them.
#pragma once

#include <string>
#include <vector>

namespace snowshed {

/// Returns the shortest text that reads back as the same number: 0.5, 210, 1e-07.
std::string show(double number);

/// Returns the number with six digits, for computed values.
std::string show_rounded(double number);

/// Returns the number with three digits, for sizes.
std::string show_briefly(double number);

/// Returns the text in quotation marks, as ASCII and shortened, so that any text can be printed.
std::string quote(const std::string& text);

/// Returns a message that a terminal may show, even if it quotes untrusted text: control
/// characters, those that turn the direction of writing, and bytes that are not UTF-8 become "?".
std::string printable(const std::string& message);

/// Returns whether the text is valid UTF-8.
bool is_utf8(const std::string& text);

/// Returns the JSON pointer (RFC 6901) of a member or an item of `parent`. Control characters
/// become "?", and keys of more than 100 characters are cut.
std::string pointer(const std::string& parent, const std::string& key);

/// Returns the names in quotation marks with commas between them.
std::string quoted_list(const std::vector<std::string>& names);

/// Returns `; did you mean "x"?` with the name nearest to `given`, or nothing if none is near.
std::string suggestion(const std::string& given, const std::vector<std::string>& names);

}  // namespace snowshed
