#include "snowshed/scene/json_text.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/io/checksum.hpp"

namespace snowshed::scene {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::string location(const std::string& text, std::size_t position, const std::string& name) {
  // The parser counts the characters it has read, the offending one included.
  const std::size_t end = std::min(text.size(), position > 0 ? position - 1 : 0);
  const auto begin = text.begin();
  const auto line = 1 + std::count(begin, begin + end, '\n');
  const std::size_t newline = end > 0 ? text.rfind('\n', end - 1) : std::string::npos;
  const std::size_t column = newline == std::string::npos ? end + 1 : end - newline;
  return name + ":" + std::to_string(line) + ":" + std::to_string(column);
}

/// The message of the library in printable characters, without its error code and position, and the
/// last text that the parser read.
std::string plain_message(std::string message, std::string last_read) {
  last_read.erase(0, last_read.find_first_not_of(' '));
  for (const std::string end : {"syntax error ", ": "}) {
    const std::size_t position = message.find(end);
    if (position != std::string::npos) {
      message.erase(0, position + end.size());
      break;
    }
  }
  message = message.substr(0, message.find("; last read"));
  for (char& c : message)
    if (c < ' ' || c > '~') c = '?';
  return "not valid JSON: " + message.substr(0, 200) +
         (last_read.empty() ? "" : ", after " + quote(last_read));
}

/// The same text with spaces for line ends and tabs between values. For its message the parser
/// keeps the text since the last string or number, and spells each blank "<U+000A>": megabytes of
/// empty lines would become gigabytes.
std::string with_plain_blanks(std::string text) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char& c = text[i];
    if (c == '"')
      quoted = !quoted;
    else if (c == '\\' && quoted)
      ++i;  // an escaped character never ends the string
    else if (!quoted && (c == '\n' || c == '\t' || c == '\r'))
      c = ' ';
  }
  return text;
}

/// Line of key `number` in a text that is valid JSON up to that key.
std::size_t line_of_key(const std::string& text, std::size_t number) {
  std::size_t line = 1, line_of_string = 1;
  bool quoted = false, behind_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (c == '\\' && quoted) {
      ++i;
    } else if (c == '"') {
      if (!quoted) line_of_string = line;
      behind_string = quoted;
      quoted = !quoted;
    } else if (!quoted && c == ':' && behind_string && --number == 0) {
      break;
    } else if (!quoted && c != ' ' && c != '\t' && c != '\n' && c != '\r') {
      behind_string = false;
    }
  }
  return line_of_string;
}

/// Receives the parser's events and builds the value. The parser itself does not recurse.
class ValueBuilder {
 public:
  ValueBuilder(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  json take() { return std::move(root_); }

  // The interface that nlohmann::json::sax_parse calls.
  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(json::number_integer_t value) { return add(value); }
  bool number_unsigned(json::number_unsigned_t value) { return add(value); }
  bool number_float(json::number_float_t value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return false; }  // not in text
  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& key) {
    ++keys_read_;
    keys_.back() = std::move(key);
    if (open_.back()->contains(keys_.back()))
      throw InputError(path(), "this key appears twice, the second time in line " +
                                   std::to_string(line_of_key(text_, keys_read_)));
    return true;
  }

  bool parse_error(std::size_t position, const std::string& last_read,
                   const nlohmann::detail::exception& error) {
    constexpr int number_overflow = 406;
    if (error.id == number_overflow)
      throw InputError(path(),
                       (last_read.size() > 60 ? last_read.substr(0, 60) + "..." : last_read) +
                           " is too large for a number");
    throw InputError(location(text_, position, name_), plain_message(error.what(), last_read));
  }

 private:
  /// Path of the value that comes next.
  std::string path() const {
    std::string path;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const bool last = i + 1 == open_.size();
      const std::size_t index = open_[i]->size() - (last ? 0 : 1);
      path = pointer(path, open_[i]->is_array() ? std::to_string(index) : keys_[i]);
    }
    return path.empty() ? "/" : path;
  }

  bool add(json value) {
    insert(std::move(value));
    return true;
  }

  bool open(json container) {
    if (open_.size() >= max_depth)
      throw InputError(path(), "nested more than " + std::to_string(max_depth) + " deep");
    open_.push_back(insert(std::move(container)));
    keys_.emplace_back();
    return true;
  }

  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  json* insert(json value) {
    if (++values_ > max_values)
      throw InputError(path(), "more than " + std::to_string(max_values) + " values");
    if (open_.empty()) return &(root_ = std::move(value));
    json& parent = *open_.back();
    if (parent.is_object()) return &(parent[keys_.back()] = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }

  const std::string& text_;
  const std::string& name_;
  json root_;
  // Open containers, outermost first. None grows while an inner one is open, so pointers stay
  // valid.
  std::vector<json*> open_;
  std::vector<std::string> keys_;
  std::size_t values_ = 0, keys_read_ = 0;
};

const std::string seal_begins = ",\n  \"checksum\": \"";

/// The end of an object, with the checksum of the text before.
std::string seal_of(const std::string& text) {
  io::Crc32 sum;
  sum.update(text.data(), text.size());
  return seal_begins + io::hexadecimal(sum.value()) + "\"\n}\n";
}

void append(std::string& out, const ordered_json& value, const std::string& indent) {
  const bool plain = std::none_of(value.begin(), value.end(),
                                  [](const ordered_json& item) { return item.is_structured(); });
  if (!value.is_structured() || value.empty()) {
    out += value.dump();
  } else if (value.is_array() && plain) {
    out += '[';
    for (const auto& item : value) out += (&item == &value.front() ? "" : ", ") + item.dump();
    out += ']';
  } else {
    const std::string deeper = indent + "  ";
    std::string before = value.is_array() ? "[\n" : "{\n";
    for (const auto& item : value.items()) {
      out += before + deeper;
      if (value.is_object()) out += json(item.key()).dump() + ": ";
      append(out, item.value(), deeper);
      before = ",\n";
    }
    out += "\n" + indent + (value.is_array() ? "]" : "}");
  }
}

}  // namespace

json parse_json(const std::string& text, const std::string& name) {
  if (text.size() > max_text_bytes)
    throw InputError(name, "longer than " + std::to_string(max_text_bytes >> 20) + " MB");
  ValueBuilder builder(text, name);
  json::sax_parse(with_plain_blanks(text), &builder);
  const std::size_t nul = text.find('\0');  // where the parser takes the text to end
  if (nul != std::string::npos)
    throw InputError(location(text, nul + 1, name), "not valid JSON: a NUL character");
  return builder.take();
}

void check_seal(const std::string& text, const std::string& name) {
  const std::size_t at = text.rfind(seal_begins);
  if (at == std::string::npos) return;
  if (text.substr(at) != seal_of(text.substr(0, at)))
    throw InputError(name, "its checksum is not that of its content");
}

std::string sealed_text(const ordered_json& object) {
  std::string text = indented_text(object);
  text.erase(text.rfind("\n}"));
  return text + seal_of(text);
}

std::string indented_text(const ordered_json& value) {
  std::string out;
  append(out, value, "");
  return out + "\n";
}

}  // namespace snowshed::scene
