// Constants of a run of the solver: options, snows, obstacles, kernels.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "snowshed/core/available_cores.hpp"
#include "snowshed/core/parallel.hpp"
#include "snowshed/methods/mpm/boundary.hpp"
#include "snowshed/methods/mpm/material_constants.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed::methods::mpm {

/// Smallest number of particles for which it is worth waking another thread twice a step.
inline constexpr int particles_per_thread = 500;

/// With contact by touch, nodes up to this distance (in cells) outside an obstacle hold snow, too.
/// The outermost of these nodes then lie on the obstacle's surface on average, wherever the surface
/// lies between the nodes.
inline constexpr double touch_margin = 0.5;

/// Memory of the contact friction for fast snow, as a sliding distance in cells. A stored impulse
/// stays at its node; the part that has not acted as friction when the snow leaves is lost. With
/// half a cell, chunks of two or more cells at 5 to 15 m/s lose at most 2 % of the friction; with a
/// whole cell, 11 %. With less than half a cell, pushes of a vibrating chunk act before its pulls
/// have reduced them.
inline constexpr double friction_reach = 0.5;

template <class T, int D>
struct Model {
  explicit Model(Options o) : Model(std::move(o), choice_of(o)) {}

  Options options;
  bool material_per_particle;
  Kernels<T> kernels;
  int max_threads;
  Boundary<T, D> boundary;
  std::vector<Material> materials;              // one per snow of options.snows
  std::vector<MaterialConstants<T>> constants;  // the same for the kernels

  /// Returns Coulomb's coefficient between the fields of events, which is that of the snow with the
  /// least friction.
  double event_friction() const {
    double slope = options.snows.front().critical_state_slope;
    for (const material::Snow& snow : options.snows)
      slope = std::min(slope, snow.critical_state_slope);
    return options.settings.event_friction * slope / std::sqrt(3.0);
  }

  bool has_affine() const { return options.settings.has_affine(); }
  bool touches() const { return options.settings.contact == ContactRule::touch; }
  bool has_plastic() const {
    return material_per_particle || options.snows.front().model == material::SnowModel::cam_clay;
  }

  /// Returns the number of threads that is worth using for this number of particles.
  int threads(std::int64_t particles) const {
    return int(std::min<std::int64_t>(max_threads, particles / particles_per_thread + 1));
  }

 private:
  static KernelChoice choice_of(const Options& options) {
    const Settings& n = options.settings;
    return {options.dimension,
            n.transfer,
            n.basis,
            options.snows.front().model,
            options.snows.size() > 1,
            options.energy,
            n.crack_band_length > 0 || n.relaxation_time > 0};
  }

  Model(Options&& o, const KernelChoice& choice)
      : options(std::move(o)),
        material_per_particle(choice.material_per_particle()),
        kernels(select_kernels<T>(choice)),
        max_threads(threads_to_use(options.settings.threads)),
        boundary(options.obstacles, options.settings.dx, std::move(options.surfaces),
                 touches() ? touch_margin * options.settings.dx : 0.0, options.forces) {
    for (const material::Snow& snow : options.snows) {
      materials.emplace_back(snow, D, options.settings);
      constants.push_back(material_constants<T>(snow, D, options.settings.softening()));
    }
  }
};

}  // namespace snowshed::methods::mpm
