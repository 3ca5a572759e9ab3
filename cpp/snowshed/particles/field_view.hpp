// Quantities of particles in files and in Python: by name, with unit and meaning, of all particles
// in the order of their storage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>

namespace snowshed::particles {

enum class FieldType { float32, float64, uint8, uint16, uint32 };

template <class T>
constexpr FieldType field_type() {
  if constexpr (std::is_same_v<T, float>) return FieldType::float32;
  if constexpr (std::is_same_v<T, double>) return FieldType::float64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return FieldType::uint8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return FieldType::uint16;
  if constexpr (std::is_same_v<T, std::uint32_t>) return FieldType::uint32;
}

/// Description of a field.
struct FieldInfo {
  std::string name, unit, meaning;  // "1" where a quantity has no unit
  int components = 1;               // values of a particle: 1, 3 (x, y, z) or 9 (matrix, by rows)
  FieldType type = FieldType::float64;
  bool stored = false;  // its view is the particles' memory; otherwise a computed copy
};

/// The values of a field. The view of a stored field shows the particles until the next call that
/// changes the simulation; then a new view is needed. A view keeps its memory alive.
struct FieldView {
  FieldInfo info;
  std::size_t count = 0;                 // particles
  std::ptrdiff_t stride = 0;             // bytes from one particle to the next
  std::shared_ptr<const void> elements;  // start at the first particle; null without particles

  /// The values of one particle.
  template <class T>
  const T* at(std::size_t particle) const {
    const char* first = static_cast<const char*>(elements.get());
    return reinterpret_cast<const T*>(first + std::ptrdiff_t(particle) * stride);
  }
};

/// Calls f(zero) with a zero of the type of a field's elements.
template <class F>
decltype(auto) with_field_type(FieldType type, F f) {
  switch (type) {
    case FieldType::float32:
      return f(float());
    case FieldType::uint8:
      return f(std::uint8_t());
    case FieldType::uint16:
      return f(std::uint16_t());
    case FieldType::uint32:
      return f(std::uint32_t());
    case FieldType::float64:
      break;
  }
  return f(double());
}

}  // namespace snowshed::particles
