// Signed distances: negative inside, positive outside, metres.
#pragma once

#include <memory>
#include <optional>

#include "snowshed/core/vec.hpp"

namespace snowshed {

/// Axis-aligned bounds; infinite where a shape is unbounded.
struct Bounds {
  Vec3 min, max;
};

/// A box in any orientation. The columns of `axes` are its right-handed unit edge directions;
/// `half` holds half its edge lengths, metres (infinite along y in two-dimensional scenes).
struct OrientedBox {
  Vec3 center;
  Mat3 axes;
  Vec3 half;
};

/// A solid given by its signed distance. Immutable and safe to share between threads.
class LevelSet {
 public:
  virtual ~LevelSet() = default;

  /// Returns the signed distance at x, metres. Far from the surface its magnitude may be a lower
  /// bound.
  virtual double distance(const Vec3& x) const = 0;

  /// Returns the unit normal at x, the direction in which the distance grows fastest. It is defined
  /// inside the solid, too. The default implementation takes central differences of `distance`.
  virtual Vec3 normal(const Vec3& x) const;

  virtual Bounds bounds() const = 0;

  /// Returns the greatest depth below the surface, metres (infinite for a half-space). Contact uses
  /// it to recognise obstacles that are too thin for the grid to resolve.
  virtual double inradius() const = 0;

  /// Returns the solid as a box if it is one. Seeding tiles boxes exactly.
  virtual std::optional<OrientedBox> oriented_box() const { return std::nullopt; }
};

using Shape = std::shared_ptr<const LevelSet>;

}  // namespace snowshed
