// The least that an MPM step can do on this machine, as a yardstick: particles to grid, grid, grid
// to particles and a linear stress, for a fixed block of snow on a dense grid. No plasticity, no
// obstacles, no sorting, no limits of the time step, no choice of anything, and nothing shared with
// the solver. Single precision, three dimensions, quadratic splines, FLIP.
#pragma once

#include <cstddef>
#include <vector>

namespace snowshed {

class BareKernel {
 public:
  /// cells[0] x cells[1] x cells[2] cells with eight particles each, sorted by cell.
  explicit BareKernel(const int (&cells)[3], int threads);

  void step();
  std::size_t size() const { return mass_.size(); }
  /// Of all particles, kg: what the transfers must not change.
  double grid_mass() const;
  double mass() const;

 private:
  static constexpr int margin = 2;          // empty cells around
  static constexpr int slab_thickness = 4;  // cells along x that one thread takes at a time

  void to_grid(int slab);
  void update_nodes(int slab);
  void to_particles(int slab);
  template <class F>
  void for_each_slab(int first, int stride, F f);
  std::size_t first_particle(int slab) const;

  int cells_[3], threads_, slabs_;
  int nodes_y_, nodes_z_;
  std::vector<float> position_[3], velocity_[3], strain_[6], mass_;
  std::vector<float> sums_, velocities_;  // eight values per node
};

}  // namespace snowshed
