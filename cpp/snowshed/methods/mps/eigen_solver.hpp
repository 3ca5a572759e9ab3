// The pressure equation by Eigen: conjugate gradients with an incomplete Cholesky factor, serially.
#pragma once

#include "snowshed/methods/mps/conjugate_gradients.hpp"
#include "snowshed/particles/neighbour_lists.hpp"

namespace snowshed::methods::mps {

/// The matrix has the given diagonal, and -weight for each pair. Unknowns with a zero diagonal keep
/// their values. The residual is relative to the source.
template <int D>
SolveReport solve_with_eigen(const particles::NeighbourLists<D>& lists,
                             const AlignedVector<float>& weight,
                             const AlignedVector<double>& diagonal,
                             const AlignedVector<double>& source, double tolerance,
                             int max_iterations, AlignedVector<double>& x);

}  // namespace snowshed::methods::mps
