// Writes, reads and checks the states of methods. A state presents each of its arrays and numbers
// to an archive once, in the order of the file. A writer stores them, and a reader fills them.
//
//   array(name, values, count)             one section; a reader demands `count` elements
//   numbers(name, number...)               one section of numbers of floating point
//   counts(name, count...)                 one section of integers that are not negative
//   packed(name, items, count, visit)      one section; visit(item, f) calls f(number) for each of
//                                          the numbers of an item
//   columns(items, column...)              a section for each member of the items
//   size(name, values)                     the number of elements, for arrays of equal length
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/vec.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods {

/// Type in which an element of an array is stored, and number of values per element.
template <class T, class = void>
struct StoredAs {
  using Type = T;
  static constexpr std::size_t count = 1;
};
template <class T>
struct StoredAs<T, std::enable_if_t<std::is_enum_v<T>>> {
  using Type = std::underlying_type_t<T>;
  static constexpr std::size_t count = 1;
};
template <class Scalar, int Rows, int Columns>
struct StoredAs<Eigen::Matrix<Scalar, Rows, Columns>> {
  using Type = Scalar;
  static constexpr std::size_t count = std::size_t(Rows) * std::size_t(Columns);
};
template <class Scalar, std::size_t N>
struct StoredAs<std::array<Scalar, N>> {
  using Type = Scalar;
  static constexpr std::size_t count = N;
};

/// A member of the items of a vector, and the section that holds it.
template <class Item, class T>
struct Column {
  const char* name;
  T Item::* member;
};
template <class Item, class T>
Column<Item, T> column(const char* name, T Item::* member) {
  return {name, member};
}

class StateWriter {
 public:
  static constexpr bool reads = false;

  explicit StateWriter(io::BinaryWriter& out) : out_(out) {}

  template <class Array>
  std::size_t size(const std::string&, const Array& values) const {
    return values.size();
  }

  template <class Array>
  void array(const std::string& name, const Array& values, std::size_t) {
    using Stored = StoredAs<typename Array::value_type>;
    out_.add(name, reinterpret_cast<const typename Stored::Type*>(values.data()),
             values.size() * Stored::count);
  }
  /// An array that files of earlier states may lack.
  template <class Array>
  void optional_array(const std::string& name, const Array& values, std::size_t count) {
    array(name, values, count);
  }

  template <class... T>
  void numbers(const std::string& name, const T&... values) {
    out_.add(name, std::vector<double>{double(values)...});
  }
  /// Numbers that files of earlier states may lack.
  template <class... T>
  void optional_numbers(const std::string& name, const T&... values) {
    numbers(name, values...);
  }
  template <class... T>
  void counts(const std::string& name, const T&... values) {
    out_.add(name, std::vector<std::int64_t>{std::int64_t(values)...});
  }

  template <class Items, class Visit>
  void packed(const std::string& name, const Items& items, std::size_t, const Visit& visit) {
    std::vector<double> values;
    for (const auto& item : items) visit(item, [&](const auto& v) { values.push_back(double(v)); });
    out_.add(name, std::move(values));
  }

  template <class Item, class... Columns>
  void columns(const std::vector<Item>& items, const Columns&... column) {
    (add_column(items, column), ...);
  }

 private:
  template <class Item, class T>
  void add_column(const std::vector<Item>& items, const Column<Item, T>& column) {
    using Stored = StoredAs<T>;
    std::vector<typename Stored::Type> values;
    for (const Item& item : items) {
      const auto* first = reinterpret_cast<const typename Stored::Type*>(&(item.*column.member));
      values.insert(values.end(), first, first + Stored::count);
    }
    out_.add(column.name, std::move(values));
  }

  io::BinaryWriter& out_;
};

/// Throws InputError if a section is missing, of another type or size, or holds values that no
/// state has. The methods check the meaning of arrays.
class StateReader {
 public:
  static constexpr bool reads = true;

  explicit StateReader(const io::BinaryReader& in) : in_(in) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(in_.path().string(), why);
  }

  template <class Array>
  std::size_t size(const std::string& name, const Array&) const {
    using Stored = StoredAs<typename Array::value_type>;
    return in_.view<typename Stored::Type>(name).size / Stored::count;
  }

  template <class Array>
  void array(const std::string& name, Array& values, std::size_t count) const {
    using Stored = StoredAs<typename Array::value_type>;
    const auto given = in_.view<typename Stored::Type>(name, count * Stored::count);
    values.resize(count);
    std::copy(given.begin(), given.end(), reinterpret_cast<typename Stored::Type*>(values.data()));
  }
  template <class Array>
  void optional_array(const std::string& name, Array& values, std::size_t count) const {
    if (in_.has(name))
      array(name, values, count);
    else
      values.assign(count, typename Array::value_type(0));
  }

  template <class... T>
  void numbers(const std::string& name, T&... values) const {
    const std::vector<double> given = in_.get<double>(name, sizeof...(T));
    check_finite(given);
    std::size_t next = 0;
    ((values = T(given[next++])), ...);
  }
  template <class... T>
  void optional_numbers(const std::string& name, T&... values) const {
    if (in_.has(name)) numbers(name, values...);
  }
  template <class... T>
  void counts(const std::string& name, T&... values) const {
    const auto given = in_.get<std::int64_t>(name, sizeof...(T));
    std::size_t next = 0;
    (take_count(given[next++], values), ...);
  }

  template <class Items, class Visit>
  void packed(const std::string& name, Items& items, std::size_t count, const Visit& visit) const {
    using Item = typename Items::value_type;
    std::size_t numbers = 0;
    Item none{};
    visit(none, [&](auto&) { ++numbers; });
    const std::vector<double> given = in_.get<double>(name, count * numbers);
    check_finite(given);
    items.assign(count, none);
    auto next = given.begin();
    for (Item& item : items)
      visit(item, [&](auto& value) { value = std::decay_t<decltype(value)>(*next++); });
  }

  template <class Item, class First, class... Columns>
  void columns(std::vector<Item>& items, const First& first, const Columns&... more) const {
    items.assign(length(first), Item{});
    take_column(items, first);
    (take_column(items, more), ...);
  }

 private:
  void check_finite(const std::vector<double>& values) const {
    for (const double value : values)
      if (!std::isfinite(value)) refuse("its numbers are not sound");
  }

  template <class T>
  void take_count(std::int64_t given, T& value) const {
    if (given < 0) refuse("a counter is negative");
    if constexpr (std::is_integral_v<T> && sizeof(T) < 8 && !std::is_same_v<T, bool>)
      if (std::uint64_t(given) > std::uint64_t(std::numeric_limits<T>::max()))
        refuse("a counter is too large");
    value = T(given);
  }

  template <class Item, class T>
  std::size_t length(const Column<Item, T>& column) const {
    return in_.view<typename StoredAs<T>::Type>(column.name).size / StoredAs<T>::count;
  }
  template <class Item, class T>
  void take_column(std::vector<Item>& items, const Column<Item, T>& column) const {
    using Stored = StoredAs<T>;
    const auto given = in_.view<typename Stored::Type>(column.name, items.size() * Stored::count);
    const auto* next = given.begin();
    for (Item& item : items) {
      auto* first = reinterpret_cast<typename Stored::Type*>(&(item.*column.member));
      std::copy(next, next + Stored::count, first);
      next += Stored::count;
    }
  }

  const io::BinaryReader& in_;
};

}  // namespace snowshed::methods
