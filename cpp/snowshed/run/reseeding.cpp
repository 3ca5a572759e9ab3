#include "snowshed/run/reseeding.hpp"

#include <limits>
#include <map>
#include <string>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/particles/point_grid.hpp"
#include "snowshed/sampling/particle_voxels.hpp"
#include "snowshed/sampling/seeding.hpp"
#include "snowshed/scene/distinct_snows.hpp"

namespace snowshed::run {
namespace {

/// The particle nearest to each point; each point must be within `reach` of one.
std::vector<std::size_t> nearest_particles(const std::vector<Vec3>& points,
                                           const std::vector<Vec3>& particles, double reach) {
  const particles::PointGrid grid(particles, reach);
  std::vector<std::size_t> nearest_index;
  for (const Vec3& x : points) {
    std::size_t best = particles.size() - 1;
    double nearest = std::numeric_limits<double>::infinity();
    grid.for_each_near(x, [&](std::size_t i, const Vec3& y) {
      const double distance = (x - y).squaredNorm();
      if (distance >= nearest) return;
      nearest = distance;
      best = i;
    });
    nearest_index.push_back(best);
  }
  return nearest_index;
}

int material_id_of(const methods::ParticleState& particles, std::size_t i) {
  return particles.material_ids.empty() ? 0 : particles.material_ids[i];
}

/// Distributes the mass of old particles over the new ones that replace them (`old_index`): each
/// snow keeps its mass, in equal parts. The mass of a snow without new particles goes to all new
/// particles.
std::vector<double> share_masses(const methods::ParticleState& old,
                                 const std::vector<std::size_t>& old_index, std::size_t snows) {
  std::vector<double> mass(snows), count(snows);
  for (std::size_t i = 0; i < old.masses.size(); ++i) mass[material_id_of(old, i)] += old.masses[i];
  for (const std::size_t i : old_index) ++count[material_id_of(old, i)];
  double placed = 0, unassigned = 0;
  for (std::size_t k = 0; k < snows; ++k) (count[k] > 0 ? placed : unassigned) += mass[k];
  std::vector<double> masses;
  for (const std::size_t i : old_index) {
    const int material_id = material_id_of(old, i);
    masses.push_back(mass[material_id] / count[material_id] * (1 + unassigned / placed));
  }
  return masses;
}

/// Points that fill the stack as a solid.
std::vector<Vec3> fill_stack(const scene::Scene& scene, const std::vector<Vec3>& stack, int event,
                             const StopRequest& stop) {
  const methods::Seeding& s = scene.seeding;
  const double dx = scene.numerics->resolution();
  const geometry::Shape solid = sampling::particles_to_level_set(
      stack, scene.dimension, dx,
      sampling::particle_radius(scene.dimension, dx, s.particles_per_voxel));
  return sampling::seed(*solid, scene.dimension, dx, s.particles_per_voxel, s.pattern,
                        s.seed + 1000003u * std::uint64_t(event) + 500000u, stop);
}

/// The new particles in batches by event and snow, which are those of the particles they replace.
std::vector<methods::ParticleBatch> batches_of(const Reseeding::Cloud& cloud,
                                               const methods::ParticleState& old,
                                               const std::vector<std::size_t>& old_index) {
  std::map<std::pair<int, int>, methods::ParticleBatch> sorted;
  for (std::size_t i = 0; i < old_index.size(); ++i) {
    const int event = old.events[old_index[i]], material_id = material_id_of(old, old_index[i]);
    methods::ParticleBatch& batch = sorted[{event, material_id}];
    batch.positions.push_back(cloud.positions[i]);
    batch.mass = cloud.masses[i];
    batch.event = event;
    batch.material_id = material_id;
  }
  std::vector<methods::ParticleBatch> batches;
  for (auto& [_, batch] : sorted) batches.push_back(std::move(batch));
  return batches;
}

}  // namespace

Reseeding reseed_stack(const scene::Scene& scene, const PanelRegion& panel,
                       methods::ParticleState old, int event, double laid_height,
                       const StopRequest& stop) try {
  const std::vector<material::Snow> snows = scene::distinct_snows(scene);
  const auto initial_density = [&](std::size_t i) {
    return snows[std::size_t(material_id_of(old, i))].density;
  };
  Reseeding r;
  r.after.positions = fill_stack(scene, old.positions, event, stop);
  const auto old_index =
      nearest_particles(r.after.positions, old.positions, 1.5 * scene.numerics->resolution());
  r.after.masses = share_masses(old, old_index, snows.size());
  for (const std::size_t i : old_index) r.after.densities.push_back(initial_density(i));
  r.after.on_panel = panel.contains(r.after.positions, laid_height);
  r.batches = batches_of(r.after, old, old_index);

  for (std::size_t i = 0; i < old.masses.size(); ++i)
    r.before.densities.push_back(initial_density(i));
  r.before.on_panel = panel.contains(old.positions, laid_height);
  r.before.positions = std::move(old.positions);
  r.before.masses = std::move(old.masses);
  return r;
} catch (const InputError& error) {
  throw SimulationError(std::string("cannot reseed the stack: ") + error.what());
}

}  // namespace snowshed::run
