#include "snowshed/run/cost_report.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/stopwatch.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

constexpr double measured_particles = 50000;

/// The speed is measured on an unbroken slab. An event of the laboratory scene takes longer by this
/// factor, because its snow yields and spreads (2D 1.3, 3D 1.4).
constexpr double broken_snow_factor = 1.35;

double speed_of(const scene::Scene& scene, const std::filesystem::path& base_dir) {
  Simulation sim(scene, base_dir);
  sim.begin_event();
  const Stopwatch clock;
  sim.run([&clock](const RunReport&) { return clock.seconds() < 0.3; }, 0.05);
  return double(sim.method().counters().particle_updates) / clock.seconds();
}

/// Particle updates per second on this machine, measured on a copy of the scene with fewer
/// particles that are seeded fast, or on the scene itself if its bodies are too small for these.
double measured_speed(const scene::Scene& scene, const std::filesystem::path& base_dir,
                      const methods::CostEstimate& cost) {
  const double n = cost.particles.empty() ? 0.0 : cost.particles.front();
  scene::Scene faster = scene;
  if (n > measured_particles)
    faster.numerics->coarsen(std::pow(n / measured_particles, 1.0 / scene.dimension));
  faster.seeding.pattern = sampling::SeedPattern::jittered;
  try {
    return speed_of(faster, base_dir);
  } catch (const InputError&) {
    return speed_of(scene, base_dir);
  }
}

/// Number of updates of unbroken snow that take as long as the updates of an event.
double work_of(const methods::CostEstimate& cost) {
  return std::max(broken_snow_factor, cost.scattering) * cost.updates;
}

}  // namespace

double expected_work(const scene::Scene& scene, const std::filesystem::path& base_dir) {
  return work_of(Simulation(scene, base_dir).cost());
}

CostReport report_cost(const scene::Scene& given, const std::filesystem::path& base_dir) {
  const scene::Scene scene = scene::resolve(given);
  CostReport report;
  for (const methods::Feature& feature :
       scene.numerics->features(scene::view_of(scene), outline_of(scene)))
    (feature.used ? report.used : report.left_out).push_back(feature.name);
  const Simulation sim(scene, base_dir);
  report.cost = sim.cost();
  report.threads = sim.threads();
  report.kernels = kernel_variant_name();
  report.device = sim.device().name();
  report.updates_per_s = measured_speed(scene, base_dir, report.cost);
  report.wall_time = work_of(report.cost) / std::max(report.updates_per_s, 1.0);
  return report;
}

}  // namespace snowshed::run
