#include "snowshed/run/cost_report.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/timer.hpp"
#include "snowshed/methods/mpm/kernel_api.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/assemble.hpp"
#include "snowshed/scene/enum_names.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

constexpr double measured_particles = 50000;

/// The speed is measured on a slab still whole; spread and yielding snow takes longer by this
/// factor over an event of the laboratory scene (2D 1.3, 3D 1.4).
constexpr double broken_snow = 1.35;

void list_feature(CostReport& report, bool used, const std::string& name) {
  (used ? report.used : report.left_out).push_back(name);
}

void list_features_of(const SlideSettings& slide, const Scene& s, CostReport& report) {
  const auto feature = [&report](bool used, const std::string& name) {
    list_feature(report, used, name);
  };
  feature(slide.bonds, "cohesive bonds");
  feature(slide.friction_law == SlideFriction::voellmy, "turbulent friction (Voellmy)");
  feature(slide.artificial_viscosity > 0, "artificial viscosity");
  feature(!s.terrain->entrainment.empty(), "entrainment and splitting");
  feature(!s.terrain->resistance.empty(), "resistance areas");
  feature(slide.cell > 0, "resampled terrain");
  feature(s.output.snapshot_interval > 0, "snapshots during the slide");
}

void list_features_of(const GrainsSettings& grains, const Scene& s, CostReport& report) {
  const auto feature = [&report](bool used, const std::string& name) {
    list_feature(report, used, name);
  };
  for (const auto& [kind, name] : EnumNames<LoadingKind>::list)
    feature(std::any_of(s.loading.begin(), s.loading.end(),
                        [kind = kind](const LoadingStage& stage) { return stage.kind == kind; }),
            name);
  feature(grains.sides == GrainSides::periodic, "periodic sides");
  feature(grains.bonded_plates, "bonded plates");
  feature(grains.density_scaling > 1, "density scaling");
  feature(s.gravity > 0, "gravity");
  feature(s.output.energy, "energy balance");
  feature(s.output.snapshot_interval > 0, "snapshots during the loading");
}

void list_features_of(const MpsSettings& mps, const Scene& s, CostReport& report) {
  const auto feature = [&report](bool used, const std::string& name) {
    list_feature(report, used, name);
  };
  feature(s.dimension == 3, "third dimension");
  feature(mps.rheology != MpsRheology::newtonian, "yield stress");
  feature(mps.rheology == MpsRheology::bingham_dilatant, "dilatant branch");
  feature(mps.erosion, "erosion and deposition");
  feature(mps.walls == MpsWalls::particles, "wall particles");
  feature(mps.spacing_law == MpsSpacing::collision, "collisions");
  feature(mps.spacing_law == MpsSpacing::shifting, "particle shifting");
  feature(mps.preconditioner == MpsPreconditioner::multigrid, "multigrid");
  feature(s.output.energy, "energy balance");
  feature(s.output.snapshot_interval > 0, "snapshots during events");
}

void list_features_of(const MpmSettings& mpm, const Scene& s, CostReport& report) {
  const auto feature = [&report](bool used, const std::string& name) {
    list_feature(report, used, name);
  };
  feature(s.dimension == 3, "third dimension");
  feature(mpm.precision == Precision::float64, "double precision");
  const std::vector<Snow> snows = assemble_snows(s);
  const bool yields = std::any_of(snows.begin(), snows.end(), [](const Snow& snow) {
    return snow.model == SnowModel::cam_clay;
  });
  feature(yields, "plasticity and hardening (Cam-Clay)");
  feature(snows.size() > 1, "several snows");
  feature(mpm.transfer == Transfer::apic, "APIC affine velocities");
  feature(mpm.basis == Basis::cubic, "cubic B-splines");
  bool conditions[3] = {s.domain.has_value(), false, false}, moving = false;
  for (const ObstacleSpec& o : assemble_obstacles(s)) {
    conditions[int(o.condition)] = true;
    moving = moving || o.motion.has_value();
  }
  for (Condition c : {Condition::sticky, Condition::slip, Condition::separate})
    feature(conditions[int(c)], std::string(name_of(c)) + " contact");
  feature(moving, "moving obstacles");
  feature(s.domain.has_value(), "domain walls");
  feature(s.events.between == Between::reseed && s.events.count > 1, "reseeding between events");
  feature(mpm.sleep_speed > 0, "sleep of snow at rest");
  feature(s.output.energy, "energy balance");
  feature(s.output.snapshot_interval > 0, "snapshots during events");
}

double speed_of(const Scene& scene, const std::filesystem::path& base_dir) {
  Simulation sim(scene, base_dir);
  sim.begin_event();
  const Stopwatch clock;
  sim.run([&clock](const RunReport&) { return clock.seconds() < 0.3; }, 0.05);
  return double(sim.solver().counters().particle_updates) / clock.seconds();
}

/// Particle updates per second on this machine, on the scene with fewer particles that are seeded
/// fast; where its bodies are too small for these, on the scene as it is.
double measured_speed(const Scene& scene, const std::filesystem::path& base_dir,
                      const CostEstimate& cost) {
  const double n = cost.particles.empty() ? 0.0 : cost.particles.front();
  Scene faster = scene;
  if (n > measured_particles && scene.uses<MpmSettings>())
    faster.mpm().dx *= std::pow(n / measured_particles, 1.0 / scene.dimension);
  faster.seeding.pattern = SeedPattern::jittered;
  try {
    return speed_of(faster, base_dir);
  } catch (const InputError&) {
    return speed_of(scene, base_dir);
  }
}

/// Of updates on a slab still whole, how many take as long as those of an event.
double work_of(const CostEstimate& cost) {
  return std::max(broken_snow, cost.scattering) * cost.updates;
}

}  // namespace

double expected_work(const Scene& scene, const std::filesystem::path& base_dir) {
  return work_of(Simulation(scene, base_dir).cost());
}

CostReport report_cost(const Scene& given, const std::filesystem::path& base_dir) {
  const Scene scene = resolve(given);
  CostReport report;
  std::visit([&](const auto& own) { list_features_of(own, scene, report); }, scene.numerics);
  const Simulation sim(scene, base_dir);
  report.cost = sim.cost();
  report.threads = sim.threads();
  report.kernels = kernel_variant();
  report.updates_per_s = measured_speed(scene, base_dir, report.cost);
  report.wall_time = work_of(report.cost) / std::max(report.updates_per_s, 1.0);
  return report;
}

}  // namespace snowshed
