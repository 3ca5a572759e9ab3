// Pressures of snow on the faces of obstacles, as means over patches.
//
// A pressure depends on the area and on the time over which it is a mean. Both are fixed here: the
// patches have the same size on every grid that resolves them, and the time is 10 ms (or a step, if
// steps are longer).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "snowshed/methods/obstacle.hpp"

namespace snowshed::io {
class BinaryReader;
class BinaryWriter;
}  // namespace snowshed::io

namespace snowshed::methods {

/// A part of an obstacle's face. It is a cell of a square lattice on two of the axes, seen along
/// the third one, in the frame of the obstacle before it moved.
struct Patch {
  std::array<std::int32_t, 5> key;  // obstacle, axis of view and side, cell along the other axes
  Vec3 point, normal;               // a point of the face (m), and its outward normal
  double area = 0;                  // m2; m per metre of width in 2D
  double pushed = 0;                // N s, in this half of a window
  double pushed_before = 0;         // N s, in the half before
  double sampled = 0;               // N s, since the last sample
  double peak = 0, peak_time = 0;   // Pa and s, of the means over a window in this event

  int obstacle() const { return key[0]; }
};

class PressureMap {
 public:
  /// A map with patches of `edge` m for obstacles in `dimension` dimensions.
  PressureMap(int dimension, double edge) : dimension_(dimension), edge_(edge) {}

  double edge() const { return edge_; }
  const std::vector<Patch>& patches() const { return patches_; }
  /// The corners of a patch in the frame of its obstacle, m: 2 in 2D, 4 in 3D.
  std::vector<Vec3> corners(const Patch&) const;

  /// Returns the index of the patch at a point of a face. Makes the patch if it is new.
  std::int32_t patch_at(int obstacle, const Vec3& point, const Vec3& normal);

  /// Adds a normal impulse, N s.
  void push(std::int32_t patch, double impulse) noexcept {
    patches_[std::size_t(patch)].pushed += impulse;
    patches_[std::size_t(patch)].sampled += impulse;
  }

  void begin_event(double time) noexcept;

  /// Whether half a window has passed, so that `end_half` must be called.
  bool half_is_over(double time) const;
  double half_end() const;  ///< s, the time from which on it is over, to rounding
  /// Ends a half of a window: all impulses up to `time` have been added.
  void end_half(double time) noexcept;

  /// The mean pressure on a patch in the last half of a window that has ended, Pa.
  double last_pressure(const Patch& patch) const {
    return half_before_ > 0 ? patch.pushed_before / (half_before_ * patch.area) : 0.0;
  }

  /// Calls f(patch, pressure) with the mean pressure (Pa) of each patch over the `duration` seconds
  /// since the last call.
  template <class F>
  void sample(double duration, const F& f) {
    for (Patch& patch : patches_) {
      f(patch, patch.sampled / (duration * patch.area));
      patch.sampled = 0;
    }
  }

  void save(io::BinaryWriter&) const;
  /// Throws InputError.
  void load(const io::BinaryReader&, std::size_t obstacles);

 private:
  Vec3 on_face(const Patch&, double first, double second) const;
  void place(Patch&) const;

  int dimension_;
  double edge_;                 // m
  double half_began_ = 0;       // s
  double half_before_ = 0;      // s, length of the half before
  std::vector<Patch> patches_;  // in the order in which snow touched them
  std::map<std::array<std::int32_t, 5>, std::int32_t> index_;
};

}  // namespace snowshed::methods
