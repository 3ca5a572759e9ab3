#include "snowshed/run/body_seeding.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/run/cost_estimate.hpp"
#include "snowshed/sampling/seeding.hpp"
#include "snowshed/sampling/voxel_set.hpp"
#include "snowshed/scene/build_shape.hpp"
#include "snowshed/scene/distinct_snows.hpp"
#include "snowshed/scene/event_bodies.hpp"
#include "snowshed/scene/shape_measure.hpp"

namespace snowshed::run {
namespace {

/// Adds the path of a body to errors of geometry, which does not know the scene.
template <class Action>
auto with_path(const std::string& path, Action action) {
  try {
    return action();
  } catch (const InputError& error) {
    if (!error.where().empty() && error.where().front() == '/') throw;
    throw InputError(path, error.what());
  } catch (const SimulationError& error) {  // beyond the addressable grid
    throw InputError(path, error.what());
  }
}

std::string body_path(std::size_t i) { return "/bodies/" + std::to_string(i) + "/shape"; }

/// The paths in the scene of the bodies that `event_bodies` returns.
std::vector<std::string> body_paths(const scene::Scene& scene, int event) {
  std::vector<std::string> paths;
  if (scene.slab) {
    const auto& layers = scene.slab->layers;
    if (layers.empty()) paths.push_back("/slab");
    for (std::size_t i = 0; i < layers.size(); ++i)
      if (scene::is_added_in(layers[i], event))
        paths.push_back("/slab/layers/" + std::to_string(i));
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene::is_added_in(scene.bodies[i], event)) paths.push_back(body_path(i));
  return paths;
}

/// A body's volume (m3, in 2D m2). If the scene does not give it, it is measured coarsely in the
/// solid, whose files are therefore read before the run.
double body_volume(const scene::BodySpec& body, const scene::Scene& scene, const std::string& path,
                   const std::filesystem::path& base_dir) {
  if (const auto volume = scene::shape_volume(body.shape, scene.dimension)) return *volume;
  return with_path(path, [&] {
    const geometry::Shape shape = scene::build_shape(body.shape, scene.dimension, path, base_dir);
    Vec3 size = shape->bounds().max - shape->bounds().min;
    if (scene.dimension == 2) size.y() = 0;  // endless
    return sampling::measure(*shape, scene.dimension,
                             std::max(scene.numerics->resolution(), size.maxCoeff() / 64));
  });
}

/// Number of particles with which the method fills a body; a rough estimate if no machine could
/// hold them.
double particles_of(const scene::BodySpec& body, const scene::Scene& scene, const std::string& path,
                    const std::filesystem::path& base_dir) {
  const double volume = scene::shape_volume(body.shape, scene.dimension).value_or(0.0);
  const double about = volume / std::pow(scene.numerics->resolution(), scene.dimension);
  if (about > 2 * sampling::max_particles) return about;  // too many to be counted
  return with_path(path, [&] {
    const geometry::Shape shape = scene::build_shape(body.shape, scene.dimension, path, base_dir);
    return double(scene.numerics->count_particles(*shape, scene.dimension));
  });
}

/// Fills a body of snow with particles of equal mass. Adds notes on it, without its path.
void seed_body(const scene::BodySpec& body, const geometry::Shape& shape, const scene::Scene& scene,
               std::uint64_t seed, const StopRequest& stop, methods::ParticleBatch& batch,
               std::vector<std::string>& notes) {
  batch.velocity = body.velocity;
  if (!scene.numerics.takes(methods::Part::seeding))
    return scene.numerics->fill(*shape, scene.dimension, stop, batch, notes);
  const double dx = scene.numerics->resolution();
  const char* unit = scene.dimension == 2 ? " m2" : " m3";
  const material::Snow& snow = scene::snow_of(scene, body);
  batch.positions =
      snowshed::sampling::seed(*shape, scene.dimension, dx, scene.seeding.particles_per_voxel,
                               scene.seeding.pattern, seed, stop);
  const double measured = sampling::measure(*shape, scene.dimension, dx, stop);
  const double volume = body.volume > 0 ? body.volume : measured;
  batch.mass = snow.density * volume / double(batch.positions.size());
  if (body.volume > 0)
    notes.push_back("its snow has the given volume of " + show_briefly(volume) + unit +
                    ", and the solid one of " + show_briefly(measured) + unit + ": a strain of " +
                    show_briefly(std::log(measured / volume)) + " that causes no stress");
  batch.material_id = scene::material_id_of(snow, scene::distinct_snows(scene));
}

}  // namespace

SeededSnow seed_event(const scene::Scene& scene, const std::filesystem::path& base_dir,
                      const PanelRegion& panel, int event, double lift, const StopRequest& stop) {
  SeededSnow snow;
  const std::vector<scene::BodySpec> bodies = scene::event_bodies(scene, event, lift);
  const std::vector<std::string> paths = body_paths(scene, event);
  const std::size_t layers = scene::slab_bodies(scene, event).size();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::uint64_t seed = scene.seeding.seed + 1000003u * std::uint64_t(event) + i;
    methods::ParticleBatch& batch = snow.batches.emplace_back();
    batch.event = event;
    std::vector<std::string> notes;
    const geometry::Shape shape = with_path(paths[i], [&] {
      const geometry::Shape built =
          scene::build_shape(bodies[i].shape, scene.dimension, paths[i], base_dir);
      seed_body(bodies[i], built, scene, seed, stop, batch, notes);
      return built;
    });
    for (const std::string& note : notes) snow.notes.push_back(paths[i] + ": " + note);
    snow.bodies.push_back({paths[i], shape, i < layers});
    snow.mass += batch.total_mass();
    if (i >= layers) snow.height_on_panel += panel.height_of(batch.positions);
  }
  if (scene.slab) snow.height_on_panel += scene::slab_thickness(*scene.slab, event);
  return snow;
}

SeededSnow seeded(std::vector<methods::ParticleBatch> batches) {
  SeededSnow snow;
  snow.batches = std::move(batches);
  for (const methods::ParticleBatch& batch : snow.batches) snow.mass += batch.total_mass();
  return snow;
}

double slab_mass(const scene::Scene& scene, int event) {
  double mass = 0;
  for (const scene::BodySpec& layer : scene::slab_bodies(scene, event))
    mass += scene::snow_of(scene, layer).density *
            scene::shape_volume(layer.shape, scene.dimension).value();
  return mass;
}

namespace {

/// Returns the numbers of particles that `seed_event` will make.
std::vector<double> count_exactly(const scene::Scene& scene,
                                  const std::filesystem::path& base_dir) {
  std::vector<double> counts;
  for (int event = 1; event <= scene.events.count; ++event) {
    const std::vector<scene::BodySpec> bodies = scene::event_bodies(scene, event);
    const std::vector<std::string> paths = body_paths(scene, event);
    double& count = counts.emplace_back(0);
    for (std::size_t i = 0; i < bodies.size(); ++i)
      count += particles_of(bodies[i], scene, paths[i], base_dir);
  }
  return counts;
}

std::vector<double> count_by_volume(const scene::Scene& scene,
                                    const std::filesystem::path& base_dir) {
  std::vector<double> counts = estimate_cost(scene).particles;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodySpec& body = scene.bodies[i];
    const double volume = body_volume(body, scene, body_path(i), base_dir);
    const double count = volume / std::pow(scene.numerics->resolution(), scene.dimension) *
                         scene.seeding.particles_per_voxel;
    if (count < 0.5) throw InputError(body_path(i), "too small to hold a particle; reduce dx");
    if (shape_volume(body.shape, scene.dimension)) continue;  // counted already
    for (int event = 1; event <= scene.events.count; ++event)
      if (scene::is_added_in(body, event)) counts[std::size_t(event - 1)] += count;
  }
  return counts;
}

}  // namespace

std::vector<double> count_particles(const scene::Scene& scene,
                                    const std::filesystem::path& base_dir) {
  return scene.numerics.takes(methods::Part::seeding) ? count_by_volume(scene, base_dir)
                                                      : count_exactly(scene, base_dir);
}

}  // namespace snowshed::run
