// Samples of grains for the tests.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "snowshed/core/random.hpp"
#include "snowshed/methods/grains/forces.hpp"
#include "snowshed/methods/grains/pair_tables.hpp"
#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {

inline constexpr double test_voxel = 5e-5;  // m

/// An image whose labels are label(i, j, k).
template <class Label>
LabelImage image_of(std::size_t nx, std::size_t ny, std::size_t nz, const Label& label) {
  LabelImage image;
  image.size = {nx, ny, nz};
  image.voxel_size = test_voxel;
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i) image.labels.push_back(std::int32_t(label(i, j, k)));
  return image;
}

/// Voronoi cells of jittered seeds, cut out of a random field of waves: ice and pores of about
/// `grain` voxels.
inline LabelImage random_snow(std::size_t n, double grain, double pores = 0.35) {
  Random random(7);
  const int m = std::max(1, int(double(n) / grain));
  std::vector<Vec3> seeds, waves;
  std::vector<double> phases;
  for (int s = 0; s < m * m * m; ++s) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    seeds.push_back(Vec3(s % m + x, s / m % m + y, s / (m * m) + z) * double(n) / m);
  }
  for (int w = 0; w < 60; ++w) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    waves.push_back(Vec3(x - 0.5, y - 0.5, z - 0.5).normalized() * 6.2831853 / (1.3 * grain));
    phases.push_back(6.2831853 * random.uniform());
  }
  return image_of(n, n, n, [&](std::size_t i, std::size_t j, std::size_t k) {
    const Vec3 x(double(i) + 0.5, double(j) + 0.5, double(k) + 0.5);
    double field = 0;
    for (std::size_t w = 0; w < waves.size(); ++w)
      field += std::cos(waves[w].dot(x) + phases[w]) / std::sqrt(30.0);
    if (field < pores) return 0;
    int nearest = 0;
    for (int s = 1; s < int(seeds.size()); ++s)
      if ((seeds[std::size_t(s)] - x).squaredNorm() <
          (seeds[std::size_t(nearest)] - x).squaredNorm())
        nearest = s;
    return nearest + 1;
  });
}

inline Options grains_of(const LabelImage& image) {
  Options o;
  o.gravity = 0;
  o.sample = make_sample(image);
  o.settings.threads = 1;
  o.settings.damping = 0;
  return o;
}

/// A loading with one stage of each kind, each tens of steps long.
inline Options all_stages_options() {
  Options o = grains_of(random_snow(26, 6));
  o.settings.density_scaling = 1e3;
  o.settings.damping = 0.2;
  o.settings.bonded_plates = true;
  o.energy = true;
  o.cone = {3e-4, 30};
  o.loading = {{LoadingKind::compress, 2, 0.02, 0},  {LoadingKind::unload, 2, 0.01, 0},
               {LoadingKind::shear, 2, 0.02, 1e5},   {LoadingKind::hold, 2, 0.01, 0},
               {LoadingKind::isotropic, 2, 0.02, 0}, {LoadingKind::stretch, 2, 0.02, 0},
               {LoadingKind::penetrate, 2, 0.05, 0}};
  return o;
}

inline std::unique_ptr<Solver> filled_solver(const Options& options) {
  auto grains = make_solver(options);
  grains->add(grains->seed());
  return grains;
}

inline void take_steps(Method& method, int steps) {
  for (int i = 0; i < steps; ++i) method.step();
}

/// Steps until all stages are done, at most `max_steps` times.
inline void load_all(Method& method, int max_steps) {
  for (int i = 0; i < max_steps && !*method.at_rest(); ++i) method.step();
}

inline std::map<std::string, double> energies_of(const Method& method) {
  std::map<std::string, double> energies;
  for (const auto& [name, joules] : capability<KeepsEnergy>(method)->energies())
    energies[name] = joules;
  return energies;
}

/// Grains at rest. A test sets poses and velocities, and then evaluates the forces.
struct PosedGrains {
  explicit PosedGrains(const Options& options) : model(options) {
    state.boundary = state.searched_boundary = initial_boundary(model.loaded_sample());
    for (const GrainConstants& grain : model.grains) {
      state.bodies.emplace_back();
      state.bodies.back().position = grain.initial_position;
      state.bodies.back().orientation = grain.initial_orientation;
    }
    std::vector<GrainPose> poses = poses_of(state.bodies);
    const std::vector<PairHistory> bonds = initial_bonds(model, poses, state.boundary);
    state.bonds = std::int64_t(bonds.size());
    PairTables tables = search_pairs(model, std::move(poses), state.boundary, bonds);
    state.pairs = std::move(tables.pairs);
    work.groups_by_body = std::move(tables.groups_by_body);
    work.results = std::move(tables.results);
    work.frames.resize(state.bodies.size() + 2);
  }
  void evaluate(double dt = 0) { evaluate_forces(model, state, work, dt); }

  Model model;
  State state;
  Workspace work;
};

}  // namespace snowshed::methods::grains
