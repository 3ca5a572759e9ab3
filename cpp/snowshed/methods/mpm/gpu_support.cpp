#include "snowshed/methods/mpm/gpu_support.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/mpm/average_layout.hpp"

namespace snowshed::methods::mpm {
std::vector<Unsupported> unsupported_on_gpu(const Options& o) {
  std::vector<Unsupported> all;
  const Settings& n = o.settings;
  const auto refuse = [&](bool used, const char* path, const std::string& is,
                          const std::string& alternative) {
    if (!used) return;
    const std::string other = alternative.empty() ? "" : "use " + alternative + ", or ";
    all.push_back({path, is + ", which a graphics card does not support; " + other +
                             "run on the processor (numerics.device \"cpu\")"});
  };
  refuse(o.dimension != 3, "/dimension", "is 2", "3");
  refuse(n.precision != Precision::float32, "/numerics/precision", "is \"double\"", "\"float\"");
  refuse(n.basis != Basis::quadratic, "/numerics/basis", "is \"cubic\"", "\"quadratic\"");
  const bool own_friction =
      std::any_of(o.obstacles.begin(), o.obstacles.end(),
                  [](const Obstacle& obstacle) { return obstacle.law.coefficient != nullptr; });
  refuse(o.laws.material || o.laws.constitutive || o.laws.body_force || own_friction, "/",
         "has laws of the user", "");
  return all;
}

void require_supported_on_gpu(const Options& options) {
  const std::vector<Unsupported> all = unsupported_on_gpu(options);
  if (all.empty()) return;
  std::string reason = all.front().reason;
  for (std::size_t i = 1; i < all.size(); ++i)
    reason += ". Also " + all[i].path + " " + all[i].reason;
  throw InputError(all.front().path, reason);
}

/// The state, the indices of strays and of the order, and a spare array; and the nodes, for blocks
/// that are not quite full, of a slab that is five cells thick.
double bytes_on_gpu(const Settings& n, bool energy, double particles) {
  constexpr double indices = 8, spare = 4;
  const double state = 15 * 4 + 4 + 2 + 1 + (n.has_affine() ? 9 * 4 : 0);
  constexpr double node = 2 * 64 + 3 * 16 + 8 + 0.4, nodes_per_particle = 0.8;
  double coarse_node = 0;  // for each node of the grid
  if (n.damps_over_length())
    coarse_node = (2 * 32 + 16) *
                  std::pow(AverageLayout<3>(n.damping_length, n.dx, n.basis, 1).per_cell(), 3);
  double radius = 0, event_node = 0;
  if (n.fields == Fields::events) {
    radius = 4;
    event_node = 24 + 2 * 27 * 4 / 64.0;  // a contact; the blocks around those of a pair
  }
  double energies = 0, node_energies = 0;
  if (energy) {
    energies = sizeof(ParticleEnergies);
    node_energies = double(sizeof(NodeEnergies) + sizeof(ParticleEnergies)) / 64;
  }
  return particles * (state + indices + spare + radius + energies +
                      (node + coarse_node + event_node + node_energies) * nodes_per_particle);
}

snowshed::gpu::KernelProgram gpu_kernels(bool energy) {
  const std::string file = energy ? "energy_kernels.cuh" : "kernels.cuh";
  return {"kernels of mpm", "#include \"snowshed/methods/mpm/gpu/" + file + "\"\n"};
}

}  // namespace snowshed::methods::mpm
