// Default contents of a file of particles.
#include "snowshed/methods/fields_by_id.hpp"
#include "snowshed/methods/method.hpp"

namespace snowshed::methods {
namespace {

void add_if_present(const Method& method, const char* name, PointCloud& cloud) {
  if (has_field(method, name)) cloud.add<float>(name, values_by_id(method, name));
}

/// Earlier files have these quantities for all methods, so files of methods without them have
/// zeros.
void add_or_zeros(const Method& method, const char* name, PointCloud& cloud) {
  cloud.add<float>(name, has_field(method, name) ? values_by_id(method, name)
                                                 : std::vector<double>(method.size()));
}

}  // namespace

PointCloud Method::snapshot() const {
  const ParticleState s = state();
  PointCloud cloud = PointCloud::moving(s.positions, s.velocities);
  cloud.add<float>("mass", s.masses);
  cloud.add<std::uint16_t>("event", s.events);
  cloud.add<float>("density", s.densities);
  add_or_zeros(*this, "pressure", cloud);
  add_or_zeros(*this, "volumetric_plastic_strain", cloud);
  cloud.add<std::int32_t>("id", s.ids);
  add_if_present(*this, "deviatoric_stress", cloud);
  add_if_present(*this, "preconsolidation_pressure", cloud);
  if (!s.material_ids.empty()) cloud.add<std::uint8_t>("material_id", s.material_ids);
  return cloud;
}

}  // namespace snowshed::methods
