#include "snowshed/methods/mpm/cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/mpm/gpu_support.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/methods/mpm/time_step.hpp"

namespace snowshed::methods::mpm {
namespace {

/// Memory of the solver. A particle holds position, velocity, elastic and plastic strain, mass, id
/// and event, with APIC an affine matrix; a grid node holds sums and velocities, in blocks that are
/// only partly filled.
struct Storage {
  double bytes_per_particle, bytes_per_voxel;
};

constexpr Storage storage(int dimension, Precision precision) {
  const bool single = precision == Precision::float32;
  if (dimension == 2) return single ? Storage{90.0, 32.0} : Storage{180.0, 64.0};
  return single ? Storage{150.0, 48.0} : Storage{300.0, 96.0};
}

/// Bytes per node-obstacle contact (twice its size, because sorting copies it) and per obstacle
/// with its shape (without its file).
struct ObstacleStorage {
  double bytes_per_contact, bytes_per_obstacle;
};

constexpr ObstacleStorage obstacle_storage(Precision precision) {
  return precision == Precision::float32 ? ObstacleStorage{100.0, 500.0}
                                         : ObstacleStorage{200.0, 1000.0};
}

/// Number of grid voxels for each voxel of snow. The splines reach beyond the snow, and snow
/// spreads.
constexpr double grid_spread = 4.0;

/// Share of the older snow that is awake from the first landing of new snow until the new snow
/// rests. It is about a half in the laboratory scene and on the wide stacks of the thesis's chapter
/// 5.
constexpr double woken_share = 0.5;

/// Work of a particle update in scattered clumps, each with its own grid blocks, over that in a
/// slab. It is 13 to 16 times as much in 3D after 125 m, and 40 times for a lone particle.
constexpr double scattered_snow(int dimension) { return dimension == 2 ? 4.0 : 15.0; }

/// Number of nodes of the grid blocks around an event's snow, for compact bodies. Many small bodies
/// far apart use more nodes than their volume suggests.
double count_nodes(const Settings& n, const std::vector<double>& volumes, int dimension) {
  constexpr double reached_blocks = 1.5;  // blocks that a body's splines reach beyond its own
  const double edge = (dimension == 2 ? block_edge<2> : block_edge<3>)*n.dx;
  double blocks = 0;
  for (const double volume : volumes) {
    const double size = std::pow(volume, 1.0 / dimension) / edge;
    blocks += std::pow(size + reached_blocks, dimension);
  }
  return blocks * (dimension == 2 ? block_nodes<2> : block_nodes<3>);
}

/// Memory of the obstacles and of the contacts with them, in bytes.
double surroundings_bytes(const Settings& n, const SceneOutline& outline, double nodes) {
  const auto [per_contact, per_obstacle] = obstacle_storage(n.precision);
  return nodes * outline.max_overlap * per_contact + per_obstacle * outline.obstacles;
}

/// Number of particle updates. New snow is awake from its release until it rests. A part of the
/// older snow is awake after new snow has landed on it.
double count_updates(const Settings& n, int events, const SnowMotion& motion,
                     const CostEstimate& estimate) {
  double old_awake_share = 1.0;
  if (n.sleep_speed > 0.0)
    old_awake_share = woken_share * std::max(0.0, 1.0 - motion.first_landing / motion.event_time);
  double particles = 0.0, old = 0.0;
  for (double added : estimate.particles) {
    particles += added + old_awake_share * old;
    old += added;
  }
  return particles * estimate.steps / events;
}

/// Number of steps: the time over the step at rest, and additional ones for the distance, because
/// steps get shorter with speed (`next_time_step`).
double steps_per_event(const Settings& n, const SnowMotion& motion, double time_step) {
  return std::ceil(motion.event_time / time_step +
                   2.0 * motion.distance / (n.dx * n.courant_factor));
}

}  // namespace

double stable_time_step(const Settings& n, const std::vector<material::Snow>& snows,
                        int dimension) {
  double limit = std::numeric_limits<double>::infinity();
  for (const material::Snow& snow : snows)
    limit = std::min(limit, elastic_time_step(snow.youngs_modulus, snow.poissons_ratio,
                                              snow.density, dimension, n.dx, n.transfer, n.basis));
  return next_time_step(limit, 0.0, n.dx, n.courant_factor);
}

CostEstimate estimate_cost(const Settings& n, const SceneView& scene, const SceneOutline& outline,
                           std::vector<double> particles) {
  const int dimension = scene.dimension, events = scene.events.count;
  CostEstimate estimate;
  estimate.particles = std::move(particles);
  estimate.total_particles =
      std::accumulate(estimate.particles.begin(), estimate.particles.end(), 0.0);
  estimate.time_step = stable_time_step(n, outline.snows, dimension);
  estimate.event_time = outline.motion.event_time;
  estimate.scattering = std::min(outline.motion.stretch, scattered_snow(dimension));
  estimate.steps = events * steps_per_event(n, outline.motion, estimate.time_step);
  estimate.updates = count_updates(n, events, outline.motion, estimate);
  const auto [per_particle, per_voxel] = storage(dimension, n.precision);
  double nodes = 0;
  for (const auto& volumes : outline.volumes) nodes += count_nodes(n, volumes, dimension);
  const double filled = grid_spread * estimate.total_particles / outline.particles_per_voxel;
  const double voxels = std::max(filled, nodes);
  estimate.bytes = per_particle * estimate.total_particles + per_voxel * voxels +
                   surroundings_bytes(n, outline, voxels);
  if (n.device != DeviceSetting::cpu)
    estimate.card_bytes = bytes_on_gpu(n, scene.output.energy, estimate.total_particles);
  return estimate;
}

std::vector<Feature> features_of(const Settings& n, const SceneView& scene,
                                 const SceneOutline& outline) {
  const bool yields = std::any_of(
      outline.snows.begin(), outline.snows.end(),
      [](const material::Snow& snow) { return snow.model == material::SnowModel::cam_clay; });
  std::vector<Feature> features{
      {"third dimension", scene.dimension == 3},
      {"double precision", n.precision == Precision::float64},
      {"plasticity and hardening (Cam-Clay)", yields},
      {"several snows", outline.snows.size() > 1},
      {"APIC affine velocities", n.transfer == Transfer::apic},
      {"FLIP with affine velocities", n.transfer == Transfer::affine_flip},
      {"damping over a length", n.damps_over_length()},
      {"crack band", n.crack_band_length > 0},
      {"relaxation of stress", n.relaxation_time > 0},
      {"contact by touch", n.contact == ContactRule::touch},
      {"fields of events", n.fields == Fields::events},
      {"cubic B-splines", n.basis == Basis::cubic}};
  for (const auto& [condition, name] : EnumNames<Condition>::list) {
    const bool of_domain = condition == Condition::sticky && outline.has_domain;
    features.push_back(
        {std::string(name) + " contact", outline.conditions[int(condition)] || of_domain});
  }
  const bool reseeds = scene.events.between == Between::reseed && scene.events.count > 1;
  features.insert(features.end(),
                  {{"moving obstacles", outline.has_moving_obstacle},
                   {"domain walls", outline.has_domain},
                   {"reseeding between events", reseeds},
                   {"sleep of snow at rest", n.sleep_speed > 0},
                   {"energy balance", scene.output.energy},
                   {"snapshots during events", scene.output.snapshot_interval > 0}});
  return features;
}

}  // namespace snowshed::methods::mpm
