// The region over the panel's face, and the snow in it.
#pragma once

#include <optional>
#include <vector>

#include "snowshed/methods/method.hpp"
#include "snowshed/scene/assemble.hpp"

namespace snowshed {

/// Empty if the scene has no panel.
class PanelRegion {
 public:
  explicit PanelRegion(const Scene& scene);

  /// Returns for each position whether snow there lies on the panel, on which the snow of all
  /// events together could lie no higher than `laid_height` (m).
  std::vector<bool> contains(const std::vector<Vec3>& positions, double laid_height) const;

  /// Returns how far positions over the face reach along its normal, from the lowest to the highest
  /// of them, m.
  double height_of(const std::vector<Vec3>& positions) const;

  /// Snow that lies on the panel.
  struct Layer {
    double mass = 0;  // kg
    double top = 0;   // m above the face
  };
  Layer snow_on(const ParticleState& particles, double laid_height) const;

 private:
  double above(const Vec3& point) const { return frame_->normal.dot(point - frame_->center); }
  bool is_over(const Vec3& point) const;  ///< above or below the face, along its normal

  std::optional<PanelFrame> frame_;
  int dimension_;
  double dx_;
};

}  // namespace snowshed
