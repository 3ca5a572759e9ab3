// Lines, words and numbers of an untrusted text.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "snowshed/core/errors.hpp"

namespace snowshed::geometry {

/// Splits a text into lines of words. Throws InputError with the file and the line.
class TextScanner {
 public:
  TextScanner(const std::filesystem::path& path, std::string_view text)
      : path_(path), text_(text) {}

  /// Moves to the next line that has words. Returns false at the end of the text.
  bool next_line() {
    while (offset_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
      ++line_;
      split(text_.substr(offset_, end - offset_));
      offset_ = std::min(end + 1, text_.size());
      if (!words_.empty()) return true;
    }
    return false;
  }

  /// Returns the words of the current line.
  const std::vector<std::string_view>& words() const { return words_; }

  /// Returns the byte at which the next line begins.
  std::size_t offset() const { return offset_; }

  /// Returns the i-th word as a number, independent of the locale.
  template <class Number>
  Number number(std::size_t i) const {
    if (i >= words_.size()) fail("too few values");
    return parse<Number>(words_[i]);
  }

  template <class Number>
  Number parse(std::string_view word) const {
    const std::string_view digits = word.substr(!word.empty() && word[0] == '+' ? 1 : 0);
    Number value{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    bool good = error == std::errc() && end == digits.data() + digits.size();
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good) fail("'" + std::string(word.substr(0, 40)) + "' is not a valid number");
    return value;
  }

  /// Throws the error. A message may quote any bytes of the text; those that cannot be printed are
  /// replaced.
  [[noreturn]] void fail(std::string what) const {
    for (char& c : what)
      if (c < ' ' || c > '~') c = '?';
    throw InputError(path_.string() + ":" + std::to_string(line_), what);
  }

 private:
  void split(std::string_view line) {
    constexpr std::string_view blanks = " \t\r\v\f";
    constexpr std::size_t max_words = 100'000;  // far more than the corners of any polygon
    words_.clear();
    for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
      if (words_.size() == max_words) fail("more than 100000 words in a line");
      const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
      words_.push_back(line.substr(begin, end - begin));
      begin = line.find_first_not_of(blanks, end);
    }
  }

  const std::filesystem::path& path_;
  std::string_view text_;
  std::size_t offset_ = 0, line_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace snowshed::geometry
