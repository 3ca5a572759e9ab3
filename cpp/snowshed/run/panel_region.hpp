// The region over the panel's face, and the snow in it.
#pragma once

#include <optional>
#include <vector>

#include "snowshed/methods/method.hpp"
#include "snowshed/scene/panel_frame.hpp"

namespace snowshed::run {

/// The region over the panel; it is empty if the scene has no panel.
class PanelRegion {
 public:
  explicit PanelRegion(const scene::Scene& scene);

  /// Returns for each position whether snow there lies on the panel. `laid_height` (m) is the
  /// height that all snow laid so far would have there.
  std::vector<bool> contains(const std::vector<Vec3>& positions, double laid_height) const;

  /// Returns the distance along the normal between the lowest and the highest of the positions over
  /// the face, m.
  double height_of(const std::vector<Vec3>& positions) const;

  /// Snow that lies on the panel.
  struct Layer {
    double mass = 0;  // kg
    double top = 0;   // m above the face
  };
  Layer snow_on(const methods::ParticleState& particles, double laid_height) const;

 private:
  double above(const Vec3& point) const { return frame_->normal.dot(point - frame_->center); }
  bool is_over(const Vec3& point) const;  ///< above or below the face, along its normal

  std::optional<scene::PanelFrame> frame_;
  int dimension_;
  double dx_;
};

}  // namespace snowshed::run
