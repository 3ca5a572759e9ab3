#include "snowshed/methods/grains/contacts.hpp"

#include <algorithm>

namespace snowshed::methods::grains {
namespace {

Vec3 triple(const AlignedVector<double>& x, const AlignedVector<double>& y,
            const AlignedVector<double>& z, std::size_t at) {
  return {x[at], y[at], z[at]};
}

}  // namespace

PairGeometry pair_geometry(const Model& model, const Boundary& boundary, const PairList& list,
                           const PairGroup& g, std::size_t p, const Vec3& position_a,
                           const Mat3& rotation_a, const GrainPose* second) {
  const Vec3 from_a = rotation_a * triple(list.ax, list.ay, list.az, p);
  const std::uint32_t kind = g.second - std::uint32_t(model.grains.size());
  if (!second && kind >= std::uint32_t(Partner::west)) {
    const Vec3 center = position_a + from_a;
    const SurfaceContact met =
        kind == std::uint32_t(Partner::cone)
            ? meet_cone(model.cone, center - boundary.tip, model.radius)
            : meet_side(boundary, int(kind) - int(Partner::west), center, model.radius);
    const Vec3 arm = from_a + (model.radius + 0.5 * met.gap) * met.normal;
    return {met.gap, met.normal, arm, Vec3::Zero()};
  }
  Vec3 center_offset = (second ? second->position : boundary.plate[kind]) - position_a;
  center_offset.x() += g.shift[0] * boundary.period(0);
  center_offset.y() += g.shift[1] * boundary.period(1);
  const Vec3 offset_b = triple(list.bx, list.by, list.bz, p);
  const Vec3 from_b = second ? Vec3(second->orientation * offset_b) : offset_b;
  const Vec3 separation = center_offset + from_b - from_a;
  const double distance = std::max(separation.norm(), 1e-30);
  const Vec3 arm = from_a + 0.5 * separation;
  return {distance - 2 * model.radius, separation / distance, arm, arm - center_offset};
}

}  // namespace snowshed::methods::grains
