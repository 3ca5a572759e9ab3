// Fields of a method's data for callers: views, which are made and found by name.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/quantities.hpp"
#include "snowshed/particles/field_view.hpp"

namespace snowshed::methods {

inline particles::FieldInfo field_of(const Quantity& q, particles::FieldType type, bool stored) {
  return {q.name, q.unit, q.meaning, q.components, type, stored};
}

template <class T>
particles::FieldView stored_view(const particles::FieldInfo& info, const AlignedVector<T>& array) {
  return {info, array.size(), sizeof(T), share(array)};
}

/// A view of values computed for it: `info.components` of each particle.
template <class T>
particles::FieldView computed_view(const particles::FieldInfo& info, std::vector<T> values) {
  const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
  return {info, owner->size() / std::size_t(info.components),
          std::ptrdiff_t(sizeof(T)) * info.components,
          std::shared_ptr<const void>(owner, owner->data())};
}

/// The values that f(particle) returns: numbers, vectors or matrices (by rows).
template <class F>
std::vector<double> values_of_each(std::size_t count, int threads, F f) {
  using Value = decltype(f(std::size_t()));
  if constexpr (std::is_arithmetic_v<Value>) {
    std::vector<double> values(count);
    parallel_for_static(std::ptrdiff_t(count), threads,
                        [&](std::ptrdiff_t i) { values[i] = f(std::size_t(i)); });
    return values;
  } else {
    constexpr int rows = Value::RowsAtCompileTime, columns = Value::ColsAtCompileTime;
    std::vector<double> values(count * rows * columns);
    parallel_for_static(std::ptrdiff_t(count), threads, [&](std::ptrdiff_t i) {
      const Value value = f(std::size_t(i));
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) values[(i * rows + r) * columns + c] = value(r, c);
    });
    return values;
  }
}

/// Shows the fields of a method's particles to `visit(info, view)`, where view() returns the view.
template <class Visit>
class FieldSources {
 public:
  FieldSources(Visit& visit, std::size_t particles, int threads)
      : visit_(visit), particles_(particles), threads_(threads) {}

  template <class T>
  void stored(const particles::FieldInfo& info, const AlignedVector<T>& array) const {
    visit_(info, [&] { return stored_view(info, array); });
  }
  /// An array that holds the quantity of this name.
  template <class T>
  void column(const char* name, const AlignedVector<T>& array) const {
    stored(field_of(quantity(name), particles::field_type<T>(), true), array);
  }
  /// The quantity of this name from values(), a vector.
  template <class Values>
  void computed(const char* name, Values values) const {
    using Value = typename std::decay_t<decltype(values())>::value_type;
    const particles::FieldInfo info =
        field_of(quantity(name), particles::field_type<Value>(), false);
    visit_(info, [&] { return computed_view(info, std::vector<Value>(values())); });
  }
  /// The quantity of this name from value(particle): a number, vector or matrix.
  template <class Value>
  void of_each(const char* name, Value value) const {
    computed(name, [&] { return values_of_each(particles_, threads_, value); });
  }

 private:
  Visit& visit_;
  std::size_t particles_;
  int threads_;
};

/// The fields that `visit_fields` shows: it calls its argument with (info, view) for each of them,
/// where view() returns the view.
template <class VisitFields>
std::vector<particles::FieldInfo> list_fields(const VisitFields& visit_fields) {
  std::vector<particles::FieldInfo> all;
  visit_fields([&all](const particles::FieldInfo& info, const auto&) { all.push_back(info); });
  return all;
}

/// The view of the field of this name; throws InputError if there is none.
template <class VisitFields>
particles::FieldView find_field(const std::string& name, const VisitFields& visit_fields) {
  std::optional<particles::FieldView> match;
  std::string names;
  visit_fields([&](const particles::FieldInfo& info, const auto& view) {
    if (info.name == name) match = view();
    names += (names.empty() ? "" : ", ") + info.name;
  });
  if (!match) throw InputError("field", "no \"" + name + "\"; there are " + names);
  return *match;
}

}  // namespace snowshed::methods
