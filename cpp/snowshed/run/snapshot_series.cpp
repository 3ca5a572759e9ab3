#include "snowshed/run/snapshot_series.hpp"

#include <cmath>
#include <cstdio>

#include "snowshed/io/vtp_writer.hpp"
#include "snowshed/methods/grains/solver.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed {
namespace {

template <class To, class From>
std::vector<To> converted(const std::vector<From>& from) {
  return std::vector<To>(from.begin(), from.end());
}

/// What is told of a slide's snow: thickness, speed, and how many bonds hold a particle. Returns
/// the bonds, by the particles' places.
PointPairs add_slide(const SlideMethod& slide, const ParticleState& s,
                     std::vector<PointArray>& arrays) {
  const FieldView view = slide.field("thickness");
  const std::vector<std::uint32_t>& order = slide.order_by_id();
  std::vector<std::uint32_t> place(order.size());
  std::vector<float> thickness, speed;
  thickness.reserve(order.size());
  speed.reserve(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    place[order[k]] = k;
    thickness.push_back(float(*view.at<double>(order[k])));
    speed.push_back(float(s.velocities[k].norm()));
  }
  PointPairs pairs;
  std::vector<std::int32_t> count(order.size(), 0);
  const Bonds& bonds = slide.bonds();
  pairs.reserve(bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    pairs.push_back({place[bonds.first[b]], place[bonds.second[b]]});
    for (const std::uint32_t particle : pairs.back()) ++count[particle];
  }
  arrays.push_back({"thickness", 1, std::move(thickness)});
  arrays.push_back({"speed", 1, std::move(speed)});
  arrays.push_back({"bonds", 1, std::move(count)});
  return pairs;
}

/// The spheres of grains, with what is known of the grain that each belongs to: its number, its
/// velocity, how many grains it touches and is bonded to, and half the sum of its contact forces.
void write_grains(const std::filesystem::path& file, const GrainsMethod& grains) {
  const std::vector<Vec3> positions = grains.sphere_positions();
  const std::vector<std::uint32_t> of = grains.sphere_grains();
  const std::vector<Vec3> velocities = grains.state().velocities;
  std::vector<std::int32_t> touching(velocities.size(), 0), bonded(velocities.size(), 0);
  std::vector<float> force(velocities.size(), 0);
  for (const GrainContact& contact : grains.grain_contacts())
    for (const std::uint32_t grain : {contact.first, contact.second}) {
      ++touching[grain];
      bonded[grain] += contact.bonded;
      force[grain] += 0.5f * float(contact.force.norm());
    }
  std::vector<std::array<float, 3>> points;
  std::vector<float> velocity;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3f x = positions[i].cast<float>(), v = velocities[of[i]].cast<float>();
    points.push_back({x[0], x[1], x[2]});
    velocity.insert(velocity.end(), {v[0], v[1], v[2]});
  }
  const auto of_grain = [&of](const auto& values) {
    std::vector<typename std::decay_t<decltype(values)>::value_type> each;
    for (const std::uint32_t grain : of) each.push_back(values[grain]);
    return each;
  };
  write_vtp(file, points,
            {{"velocity", 3, std::move(velocity)},
             {"grain", 1, converted<std::int32_t>(of)},
             {"touching_grains", 1, of_grain(touching)},
             {"bonded_grains", 1, of_grain(bonded)},
             {"contact_force", 1, of_grain(force)}});
}

/// Quantities of which only some methods know.
void add_stresses(const Method& solver, std::vector<PointArray>& arrays) {
  for (const FieldInfo& info : solver.fields()) {
    if (info.name != "deviatoric_stress" && info.name != "preconsolidation_pressure") continue;
    const FieldView view = solver.field(info.name);
    std::vector<float> values;
    values.reserve(view.count);
    for (const std::uint32_t place : solver.order_by_id())
      values.push_back(float(*view.at<double>(place)));
    arrays.push_back({info.name, 1, std::move(values)});
  }
}

/// What a file of particles holds.
struct PointCloud {
  std::vector<std::array<float, 3>> points;
  std::vector<PointArray> arrays;
  PointPairs lines;
};

PointCloud point_cloud(const Method& solver) {
  const ParticleState s = solver.state();
  PointCloud cloud;
  std::vector<float> velocity;
  cloud.points.reserve(s.positions.size());
  velocity.reserve(3 * s.positions.size());
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    const Eigen::Vector3f x = s.positions[i].cast<float>(), v = s.velocities[i].cast<float>();
    cloud.points.push_back({x[0], x[1], x[2]});
    velocity.insert(velocity.end(), {v[0], v[1], v[2]});
  }
  cloud.arrays = {{"velocity", 3, std::move(velocity)},
                  {"mass", 1, converted<float>(s.masses)},
                  {"event", 1, s.events},
                  {"density", 1, converted<float>(s.densities)},
                  {"pressure", 1, converted<float>(s.pressures)},
                  {"volumetric_plastic_strain", 1, converted<float>(s.plastic_strains)},
                  {"id", 1, converted<std::int32_t>(s.ids)}};
  add_stresses(solver, cloud.arrays);
  if (!s.material_ids.empty()) cloud.arrays.push_back({"snow", 1, s.material_ids});
  if (const auto* slide = dynamic_cast<const SlideMethod*>(&solver))
    cloud.lines = add_slide(*slide, s, cloud.arrays);
  return cloud;
}

}  // namespace

void write_particles(const std::filesystem::path& file, const Method& solver) {
  if (const auto* grains = dynamic_cast<const GrainsMethod*>(&solver))
    return write_grains(file, *grains);
  const PointCloud cloud = point_cloud(solver);
  write_vtp(file, cloud.points, cloud.arrays, cloud.lines);
}

SnapshotSeries::SnapshotSeries(std::filesystem::path folder, double interval, double time)
    : folder_(std::move(folder)),
      interval_(interval),
      // On multiples of the interval, so that a resumed run writes the same snapshots.
      next_(std::ceil(time / interval - 1e-9) * interval),
      series_((std::filesystem::create_directories(folder_),
               PvdSeries::reopen(folder_ / "snapshots.pvd", next_))) {}

void SnapshotSeries::write(const Method& solver) {
  char name[32];
  std::snprintf(name, sizeof name, "snapshot_%06lld.vtp",
                static_cast<long long>(std::llround(next_ / interval_)));
  write_particles(folder_ / name, solver);
  series_.append(solver.time(), name);
  while (next_ <= solver.time()) next_ += interval_;
}

}  // namespace snowshed
