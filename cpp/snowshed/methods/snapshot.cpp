// Default contents of a file of particles.
#include "snowshed/methods/method.hpp"

namespace snowshed {
namespace {

/// Quantities that only some methods have.
void add_stresses(const Method& method, PointCloud& cloud) {
  for (const FieldInfo& info : method.fields()) {
    if (info.name != "deviatoric_stress" && info.name != "preconsolidation_pressure") continue;
    const FieldView view = method.field(info.name);
    std::vector<float> values;
    values.reserve(view.count);
    for (const std::uint32_t place : method.order_by_id())
      values.push_back(float(*view.at<double>(place)));
    cloud.arrays.push_back({info.name, 1, std::move(values)});
  }
}

}  // namespace

PointCloud Method::snapshot() const {
  ParticleState s = state();
  PointCloud cloud = PointCloud::moving(s.positions, s.velocities);
  cloud.add<float>("mass", s.masses);
  cloud.add<std::uint16_t>("event", s.events);
  cloud.add<float>("density", s.densities);
  cloud.add<float>("pressure", s.pressures);
  s.plastic_strains.resize(s.positions.size());  // earlier files have it for all methods
  cloud.add<float>("volumetric_plastic_strain", s.plastic_strains);
  cloud.add<std::int32_t>("id", s.ids);
  add_stresses(*this, cloud);
  if (!s.material_ids.empty()) cloud.add<std::uint8_t>("material_id", s.material_ids);
  return cloud;
}

}  // namespace snowshed
