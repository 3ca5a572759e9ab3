// A preconditioner for the pressure equation: multigrid over the cells of the neighbour search.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/core/aligned_vector.hpp"
#include "snowshed/methods/mps/kernel_api.hpp"
#include "snowshed/particles/cell_order.hpp"
#include "snowshed/particles/neighbour_lists.hpp"

namespace snowshed::methods::mps {

/// Aggregation multigrid (Notay 2010; Braess 1995, doi:10.1007/BF02238484): the unknowns of a cell
/// are one unknown of the next level, and 2^D unknowns of a level are one unknown of the level
/// above. Corrections are constant within an aggregate, and enlarged to compensate for this. One
/// damped Jacobi sweep before and one after each correction keep the cycle symmetric, as conjugate
/// gradients require. A particle has C unknowns; above the particles they are independent of each
/// other.
template <int D, int C>
class Multigrid {
 public:
  /// The matrix has the given diagonal, and -weight for each pair of neighbours. Unknowns with a
  /// zero diagonal are left out: their values stay zero. `period_cells`: the period along x in
  /// cells, or 0.
  void update(const particles::NeighbourLists<D>& lists, const AlignedVector<float>& weight,
              const AlignedVector<double>& diagonal, const particles::CellOrder<D>& cells,
              std::int32_t period_cells, int threads);

  /// z = M^-1 r, for one unknown.
  void apply(const double* r, double* z);

  /// Adds to the particles' unknowns the correction that the levels above make from the residual.
  template <class T>
  void correct(const T* residual, T* x);

  std::size_t levels() const { return 1 + levels_.size(); }
  std::size_t bytes() const;

 private:
  using Coordinates = std::array<std::int32_t, D>;
  using Value = Eigen::Array<float, C, 1>;
  static constexpr int stencil = D == 2 ? 9 : 27;

  /// A level above the particles: rows of at most `stencil` entries, including the row's own.
  struct Level {
    std::vector<Coordinates> coordinates;
    std::vector<std::uint32_t> child_first;  // ranges of `child` for the level below
    std::vector<std::uint32_t> child;
    std::vector<std::uint32_t> parent;   // in the level above
    AlignedVector<float> value;          // stencil of each row, positive couplings
    AlignedVector<std::int32_t> column;  // or -1
    AlignedVector<float> diagonal, inverse;
    AlignedVector<Value> x, b, r;
    std::int32_t period = 0;
    std::size_t size() const { return coordinates.size(); }
  };

  void make_first(const particles::CellOrder<D>& cells, std::int32_t period_cells);
  void make_next();
  template <class Visit>
  void fill(Level& level, const Visit& visit);
  void fill_first();
  void fill_next(const Level& below, Level& level);
  void factor_coarsest();
  void cycle(std::size_t level, bool from_zero);
  void sweep(Level& level);
  void residual(Level& level);

  const Kernels<D>& kernels_ = chosen_kernels<D>();
  const particles::NeighbourLists<D>* lists_ = nullptr;
  const float* weight_ = nullptr;
  std::size_t size_ = 0;
  int threads_ = 1;
  AlignedVector<float> inverse_, diagonal_, x_, b_, r_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys_;
  std::vector<Level> levels_;
  Eigen::LLT<Eigen::MatrixXf> coarsest_;
};

}  // namespace snowshed::methods::mps
