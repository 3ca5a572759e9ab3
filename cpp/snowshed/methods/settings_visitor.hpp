// Interface by which a method describes its settings to any visitor.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <typeindex>
#include <vector>

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/range.hpp"

namespace snowshed::methods {

/// A value of any enumeration with names (enum_names.hpp).
class Choice {
 public:
  template <class E, class = std::enable_if_t<std::is_enum_v<E>>>
  Choice(E& value)  // implicit, so that visitors take any enumeration
      : address_(&value), type_(typeid(E)), number_(int(value)), name_(name_of(value)) {
    for (const auto& named : EnumNames<E>::list) names_.emplace_back(named.name);
    choose_ = [&value](std::size_t i) { value = EnumNames<E>::list[i].value; };
  }

  const std::vector<std::string>& names() const { return names_; }
  const char* name() const { return name_; }  ///< null for a value outside the enumeration
  int number() const { return number_; }
  /// Changes the value to the one with names()[i].
  void choose(std::size_t i) const { choose_(i); }
  bool is_at(const void* address, std::type_index type) const {
    return address == address_ && type == type_;
  }

 private:
  const void* address_;
  std::type_index type_;
  int number_;
  const char* name_;
  std::vector<std::string> names_;
  std::function<void(std::size_t)> choose_;
};

/// A visitor of settings; scene/describe.hpp explains the calls.
class SettingsVisitor {
 public:
  virtual ~SettingsVisitor() = default;

  virtual void number(const char* key, double& value, const char* unit, const Range& range,
                      const char* doc) = 0;
  virtual void number_instead(const char* key, std::optional<double>& value, const char* other,
                              const char* unit, const Range& range, const char* doc) = 0;
  virtual void integer(const char* key, int& value, const Range& range, const char* doc) = 0;
  virtual void flag(const char* key, bool& value, const char* doc) = 0;
  virtual void choice(const char* key, const Choice& value, const char* doc) = 0;
  virtual void alias(const char* key, const char* other) = 0;
  virtual void accuracy(std::initializer_list<const char*> keys) = 0;
};

}  // namespace snowshed::methods
