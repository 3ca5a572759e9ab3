// Signed distances: negative inside, positive outside, metres.
#pragma once

#include <memory>
#include <optional>

#include "snowshed/core/vec.hpp"

namespace snowshed::geometry {

/// Axis-aligned bounds; infinite if a shape is unbounded.
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

  /// Returns bounds of the part in which the surface is not a plane: finite for a half-space with a
  /// pit.
  virtual Bounds non_planar_bounds() const { return bounds(); }

  /// Returns the greatest depth below the surface, metres (infinite for a half-space).
  virtual double inradius() const = 0;

  /// Returns half the thickness (m) of the part that is nearest to x; by default, half that of the
  /// thickest part.
  virtual double half_thickness(const Vec3& /*x*/) const { return inradius(); }

  /// Returns a lower bound of half of the thickness anywhere, metres; 0 if none is known. Contact
  /// uses it to skip solids that the grid resolves.
  virtual double min_half_thickness() const { return is_convex() ? inradius() : 0.0; }

  virtual bool is_convex() const { return false; }

  /// Returns the solid as a box if it is one. Seeding tiles boxes exactly.
  virtual std::optional<OrientedBox> oriented_box() const { return std::nullopt; }
};

using Shape = std::shared_ptr<const LevelSet>;

}  // namespace snowshed::geometry
