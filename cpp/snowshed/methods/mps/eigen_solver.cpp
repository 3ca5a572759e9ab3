#include "snowshed/methods/mps/eigen_solver.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <vector>

namespace snowshed::methods::mps {

template <int D>
SolveReport solve_with_eigen(const particles::NeighbourLists<D>& lists,
                             const AlignedVector<float>& weight,
                             const AlignedVector<double>& diagonal,
                             const AlignedVector<double>& source, double tolerance,
                             int max_iterations, AlignedVector<double>& x) {
  std::vector<int> row_of(lists.size(), -1);
  int rows = 0;
  for (std::size_t i = 0; i < lists.size(); ++i)
    if (diagonal[i] > 0) row_of[i] = rows++;
  if (rows == 0) return {};
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(lists.pairs() + std::size_t(rows));
  Eigen::VectorXd b(rows), guess(rows);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (row_of[i] < 0) continue;
    entries.emplace_back(row_of[i], row_of[i], diagonal[i]);
    b[row_of[i]] = source[i];
    guess[row_of[i]] = x[i];
    for (std::uint32_t e = lists.begin(i); e < lists.end(i); ++e)
      if (const int column = row_of[lists.neighbour(e)]; column >= 0)
        entries.emplace_back(row_of[i], column, -double(weight[e]));
  }
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper,
                           Eigen::IncompleteCholesky<double>>
      solver;
  solver.setTolerance(tolerance);
  solver.setMaxIterations(max_iterations);
  solver.compute(matrix);
  const Eigen::VectorXd solution = solver.solveWithGuess(b, guess);
  for (std::size_t i = 0; i < lists.size(); ++i)
    if (row_of[i] >= 0) x[i] = solution[row_of[i]];
  return {int(solver.iterations()), solver.error(), solver.info() == Eigen::Success};
}

template SolveReport solve_with_eigen(const particles::NeighbourLists<2>&,
                                      const AlignedVector<float>&, const AlignedVector<double>&,
                                      const AlignedVector<double>&, double, int,
                                      AlignedVector<double>&);
template SolveReport solve_with_eigen(const particles::NeighbourLists<3>&,
                                      const AlignedVector<float>&, const AlignedVector<double>&,
                                      const AlignedVector<double>&, double, int,
                                      AlignedVector<double>&);

}  // namespace snowshed::methods::mps
