// A minimal MPM step, the reference for the speed of the solver on a machine. It consists of
// particles-to-grid (P2G), grid update, grid-to-particles (G2P) and a linear stress for a fixed
// block of snow on a dense grid. It has no plasticity, obstacles, sorting, time step control or
// options, and shares no code with the solver. Single precision, three dimensions, quadratic
// splines, FLIP.
#pragma once

#include <cstddef>
#include <vector>

namespace snowshed {

class BareKernel {
 public:
  /// Fills cells[0] x cells[1] x cells[2] cells with eight particles each, sorted by cell.
  explicit BareKernel(const int (&cells)[3], int threads);

  void step();
  std::size_t size() const { return mass_.size(); }
  /// Returns the mass on the grid, kg. It must equal the mass of the particles.
  double grid_mass() const;
  /// Returns the mass of all particles, kg.
  double mass() const;

 private:
  static constexpr int margin = 2;          // empty cells on every side
  static constexpr int slab_thickness = 4;  // cells along x in the unit of work of a thread

  void particles_to_grid(int slab);
  void update_nodes(int slab);
  void grid_to_particles(int slab);
  template <class F>
  void for_each_slab(int first, int stride, F f);
  std::size_t first_particle(int slab) const;

  int cells_[3], threads_, slabs_;
  int nodes_y_, nodes_z_;
  std::vector<float> position_[3], velocity_[3], mass_;
  std::vector<float> strain_[6];          // left Cauchy-Green tensor minus identity
  std::vector<float> sums_, velocities_;  // eight values per node
};

}  // namespace snowshed
