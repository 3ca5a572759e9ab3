// A film of particles: the contents of its header and its frames, in whole numbers.
// docs/reference/film.md describes the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace snowshed::io {

/// A quantity of particles in a film. A value v is stored as round(64 asinh(v / (64 step))):
/// the resolution is `step` for small values, and 1.6 % for large ones.
struct FilmQuantity {
  std::string name, unit, meaning;
  double step = 0;

  static constexpr double linear_steps = 64;
  std::int32_t code(double value) const;
  double value(std::int32_t code) const;
};

struct FilmHeader {
  int axes = 3;         // 2: x and z; 3: x, y and z
  double quantum = 0;   // m, of positions
  double interval = 0;  // s, between frames; longer in long events
  double share = 1;     // share of the particles that is recorded, chosen by id
  bool has_radius = false;
  std::vector<FilmQuantity> quantities;

  /// Whether the particle is recorded; the same in every frame.
  bool records(std::uint32_t id) const {
    return double(id * 2654435769u) < share * 4294967296.0;  // multiples of the golden ratio
  }
};

/// All recorded particles at a time, ordered by id.
struct FilmFrame {
  double time = 0;  // s, through all events
  std::uint32_t event = 0;
  std::vector<std::uint32_t> ids;
  std::vector<std::uint16_t> events;                 // event of each particle
  std::vector<std::uint8_t> materials;               // material of each particle
  std::vector<std::int32_t> radii;                   // in quanta; empty if the header has none
  std::vector<std::vector<std::int32_t>> positions;  // one list per axis, in quanta
  std::vector<std::vector<std::int32_t>> values;     // codes, one list per quantity
};

}  // namespace snowshed::io
