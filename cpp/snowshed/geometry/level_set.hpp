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

  /// Signed distance at x, metres; at least a lower bound of its magnitude far away.
  virtual double distance(const Vec3& x) const = 0;

  /// Unit normal: the direction in which the distance grows fastest, defined inside too.
  /// The default takes central differences of `distance`.
  virtual Vec3 normal(const Vec3& x) const;

  virtual Bounds bounds() const = 0;

  /// Greatest depth below the surface, metres (infinite for a half-space).
  /// Contact uses it to recognise bodies thinner than the grid can see.
  virtual double inradius() const = 0;

  /// The solid itself where it is a box: lets seeding tile it exactly.
  virtual std::optional<OrientedBox> oriented_box() const { return std::nullopt; }
};

using Shape = std::shared_ptr<const LevelSet>;

}  // namespace snowshed
