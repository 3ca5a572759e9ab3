#include "snowshed/run/panel_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snowshed::run {

PanelRegion::PanelRegion(const scene::Scene& scene)
    : dimension_(scene.dimension), dx_(scene.numerics->resolution()) {
  if (scene.panel) frame_ = scene::panel_frame(scene);
}

bool PanelRegion::is_over(const Vec3& point) const {
  const Vec3 x = point - frame_->center;
  return std::abs(frame_->slope.dot(x)) < 0.5 * frame_->length &&
         (dimension_ == 2 || std::abs(x.y()) < 0.5 * frame_->width);
}

std::vector<bool> PanelRegion::contains(const std::vector<Vec3>& positions,
                                        double laid_height) const {
  std::vector<bool> over_panel(positions.size(), false);
  if (!frame_) return over_panel;
  const double height = 2 * dx_ + laid_height;
  for (std::size_t i = 0; i < over_panel.size(); ++i) {
    const double z = above(positions[i]);
    over_panel[i] = z > -dx_ && z < height && is_over(positions[i]);
  }
  return over_panel;
}

double PanelRegion::height_of(const std::vector<Vec3>& positions) const {
  if (!frame_) return 0.0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& x : positions) {
    if (!is_over(x)) continue;
    low = std::min(low, above(x));
    high = std::max(high, above(x));
  }
  return std::max(0.0, high - low);
}

PanelRegion::Layer PanelRegion::snow_on(const methods::ParticleState& particles,
                                        double laid_height) const {
  const std::vector<bool> over_panel = contains(particles.positions, laid_height);
  Layer layer;
  for (std::size_t i = 0; i < over_panel.size(); ++i) {
    if (!over_panel[i]) continue;
    layer.mass += particles.masses[i];
    layer.top = std::max(layer.top, above(particles.positions[i]));
  }
  return layer;
}

}  // namespace snowshed::run
