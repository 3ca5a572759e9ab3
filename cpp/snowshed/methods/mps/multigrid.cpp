#include "snowshed/methods/mps/multigrid.hpp"

#include <algorithm>
#include <utility>

#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mps {
namespace {

constexpr float jacobi_damping = 0.9f;  // damping of Jacobi sweeps
// Enlargement of corrections that are constant within an aggregate: first level, and higher levels.
constexpr float first_enlargement = 1.4f, enlargement = 1.8f;
constexpr std::size_t max_direct_unknowns = 64;  // unknowns of the level that is solved directly
constexpr std::size_t max_levels = 24;
constexpr std::ptrdiff_t rows_in_piece = 128;
constexpr std::size_t rows_per_thread = 500;

template <class F>
void for_each_row(std::size_t n, int threads, F f) {
  threads = int(std::clamp<std::size_t>(n / rows_per_thread, 1, std::size_t(threads)));
  parallel_pieces(std::ptrdiff_t(n), threads, rows_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t i = begin; i < end; ++i) f(std::size_t(i));
                  });
}

/// Index of the aggregate `to` among the 3^D around the aggregate `from`.
template <std::size_t D>
int slot_of(const std::array<std::int32_t, D>& from, const std::array<std::int32_t, D>& to,
            std::int32_t period) {
  int slot = 0;
  for (int d = int(D) - 1; d >= 0; --d) {
    std::int32_t step = to[std::size_t(d)] - from[std::size_t(d)];
    if (d == 0 && period > 0) {
      if (2 * step > period) step -= period;
      if (2 * step < -period) step += period;
    }
    slot = 3 * slot + step + 1;
  }
  return slot;
}

}  // namespace

/// Makes the first level, with one aggregate for each cell.
template <int D, int C>
void Multigrid<D, C>::make_first(const particles::CellOrder<D>& cells, std::int32_t period_cells) {
  Level& level = levels_.front();
  level.period = period_cells;
  level.coordinates.resize(cells.cells());
  level.child_first.resize(cells.cells() + 1);
  level.child.clear();  // the points of a cell are consecutive
  parent_.resize(size_);
  for (std::size_t c = 0; c < cells.cells(); ++c) {
    level.coordinates[c] = cells.coordinates(c);
    --level.coordinates[c][0];
    level.child_first[c] = cells.begin(c);
    for (std::uint32_t i = cells.begin(c); i < cells.end(c); ++i) parent_[i] = std::uint32_t(c);
  }
  level.child_first.back() = std::uint32_t(size_);
}

/// Makes the next level, with one aggregate for 2^D of the level below.
template <int D, int C>
void Multigrid<D, C>::make_next() {
  levels_.emplace_back();
  Level& level = levels_.back();
  Level& below = levels_[levels_.size() - 2];
  level.period = below.period > 0 ? (below.period + 1) / 2 : 0;
  keys_.clear();
  for (std::uint32_t i = 0; i < below.size(); ++i) {
    std::uint64_t key = 0;
    for (int d = D - 1; d >= 0; --d)
      key = (key << (D == 2 ? 31 : 21)) | std::uint64_t(below.coordinates[i][std::size_t(d)] >> 1);
    keys_.emplace_back(key, i);
  }
  std::sort(keys_.begin(), keys_.end());
  below.parent.resize(below.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const std::uint32_t i = keys_[k].second;
    if (k == 0 || keys_[k].first != keys_[k - 1].first) {
      Coordinates at = below.coordinates[i];
      for (auto& c : at) c >>= 1;
      level.coordinates.push_back(at);
      level.child_first.push_back(std::uint32_t(k));
    }
    level.child.push_back(i);
    below.parent[i] = std::uint32_t(level.size() - 1);
  }
  level.child_first.push_back(std::uint32_t(keys_.size()));
}

/// Makes the rows of a level: visit(c, add_diagonal, add) adds the diagonal of the unknowns in
/// aggregate c, and their couplings with unknowns in other aggregates or in c itself.
template <int D, int C>
template <class Visit>
void Multigrid<D, C>::fill(Level& level, const Visit& visit) {
  level.value.resize(level.size() * stencil);
  level.column.resize(level.size() * stencil);
  level.diagonal.resize(level.size());
  for_each_row(level.size(), threads_, [&](std::size_t c) {
    float* const value = &level.value[c * stencil];
    std::int32_t* const column = &level.column[c * stencil];
    std::fill_n(value, stencil, 0.0f);
    std::fill_n(column, stencil, std::int32_t(c));
    float diagonal_sum = 0;
    visit(
        c, [&](float diagonal) { diagonal_sum += diagonal; },
        [&](std::uint32_t other, float coupling) {
          if (other == c) {
            diagonal_sum -= coupling;
            return;
          }
          const int slot = slot_of(level.coordinates[c], level.coordinates[other], level.period);
          value[slot] += coupling;
          column[slot] = std::int32_t(other);
        });
    level.diagonal[c] = diagonal_sum;
  });
}

template <int D, int C>
void Multigrid<D, C>::fill_first() {
  Level& level = levels_.front();
  fill(level, [&](std::size_t c, const auto& add_diagonal, const auto& add) {
    for (std::uint32_t i = level.child_first[c]; i < level.child_first[c + 1]; ++i) {
      if (diagonal_[i] == 0) continue;
      add_diagonal(diagonal_[i]);
      // Neighbours in the same cell are consecutive.
      std::uint32_t last = std::uint32_t(c);
      float sum = 0;
      for (std::uint32_t e = lists_->begin(i); e < lists_->end(i); ++e) {
        const std::uint32_t j = lists_->neighbour(e);
        if (diagonal_[j] == 0) continue;
        if (parent_[j] != last) {
          add(last, sum);
          last = parent_[j];
          sum = 0;
        }
        sum += weight_[e];
      }
      add(last, sum);
    }
  });
}

template <int D, int C>
void Multigrid<D, C>::fill_next(const Level& below, Level& level) {
  fill(level, [&](std::size_t c, const auto& add_diagonal, const auto& add) {
    for (std::uint32_t k = level.child_first[c]; k < level.child_first[c + 1]; ++k) {
      const std::size_t row = std::size_t(level.child[k]);
      add_diagonal(below.diagonal[row]);
      for (std::size_t s = row * stencil; s < (row + 1) * stencil; ++s)
        add(below.parent[std::size_t(below.column[s])], below.value[s]);
    }
  });
}

/// Factors the matrix of the coarsest level. A small increase of the diagonal keeps it positive
/// definite in spite of rounding, even if there is no free surface.
template <int D, int C>
void Multigrid<D, C>::factor_coarsest() {
  const Level& level = levels_.back();
  const Eigen::Index n = Eigen::Index(level.size());
  Eigen::MatrixXf a = Eigen::MatrixXf::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const float d = level.diagonal[std::size_t(i)];
    a(i, i) += d > 0 ? d * 1.0001f : 1.0f;
    for (int s = 0; s < stencil; ++s) {
      const std::size_t k = std::size_t(i) * stencil + std::size_t(s);
      a(i, level.column[k]) -= level.value[k];
    }
  }
  coarsest_.compute(a);
  if (coarsest_.info() != Eigen::Success)
    coarsest_.compute(Eigen::MatrixXf(a.diagonal().asDiagonal()));
}

template <int D, int C>
void Multigrid<D, C>::update(const particles::NeighbourLists<D>& lists,
                             const AlignedVector<float>& weight,
                             const AlignedVector<double>& diagonal,
                             const particles::CellOrder<D>& cells, std::int32_t period_cells,
                             int threads) {
  lists_ = &lists;
  weight_ = weight.data();
  size_ = lists.size();
  threads_ = threads;
  for (auto* vector : {&diagonal_, &inverse_, &x_, &b_, &r_}) vector->resize(size_);
  for_each_row(size_, threads_, [&](std::size_t i) {
    diagonal_[i] = float(diagonal[i]);
    inverse_[i] = diagonal_[i] > 0 ? jacobi_damping / diagonal_[i] : 0.0f;
  });
  levels_.clear();
  levels_.reserve(max_levels);
  levels_.emplace_back();
  make_first(cells, period_cells);
  fill_first();
  while (levels_.back().size() > max_direct_unknowns && levels_.size() < max_levels) {
    make_next();
    fill_next(levels_[levels_.size() - 2], levels_.back());
  }
  for (Level& level : levels_) {
    for (auto* vector : {&level.x, &level.b, &level.r}) vector->resize(level.size());
    level.inverse.resize(level.size());
    for (std::size_t i = 0; i < level.size(); ++i)
      level.inverse[i] = level.diagonal[i] > 0 ? jacobi_damping / level.diagonal[i] : 0.0f;
  }
  factor_coarsest();
}

/// r = b - A x.
template <int D, int C>
void Multigrid<D, C>::residual(Level& level) {
  for_each_row(level.size(), threads_, [&](std::size_t i) {
    Value sum = level.b[i] - level.diagonal[i] * level.x[i];
    for (std::size_t k = i * stencil; k < (i + 1) * stencil; ++k)
      sum += level.value[k] * level.x[std::size_t(level.column[k])];
    level.r[i] = sum;
  });
}

template <int D, int C>
void Multigrid<D, C>::sweep(Level& level) {
  residual(level);
  for_each_row(level.size(), threads_,
               [&](std::size_t i) { level.x[i] += level.inverse[i] * level.r[i]; });
}

/// Improves x of a level for a given b, from zero or from the present x.
template <int D, int C>
void Multigrid<D, C>::cycle(std::size_t l, bool from_zero) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size()) {
    using Values = Eigen::Matrix<float, C, Eigen::Dynamic>;  // columns: unknowns of an aggregate
    const Eigen::Index n = Eigen::Index(level.size());
    const Eigen::Map<const Values> b(level.b.data()->data(), C, n);
    Eigen::Map<Values>(level.x.data()->data(), C, n) = coarsest_.solve(b.transpose()).transpose();
    return;
  }
  if (from_zero)
    for_each_row(level.size(), threads_,
                 [&](std::size_t i) { level.x[i] = level.inverse[i] * level.b[i]; });
  else
    sweep(level);
  residual(level);
  Level& above = levels_[l + 1];
  for_each_row(above.size(), threads_, [&](std::size_t c) {
    Value sum = Value::Zero();
    for (std::uint32_t k = above.child_first[c]; k < above.child_first[c + 1]; ++k)
      sum += level.r[above.child[k]];
    above.b[c] = sum;
  });
  cycle(l + 1, true);
  if (l + 2 < levels_.size()) cycle(l + 1, false);
  for_each_row(level.size(), threads_,
               [&](std::size_t i) { level.x[i] += enlargement * above.x[level.parent[i]]; });
  sweep(level);
}

template <int D, int C>
template <class T>
void Multigrid<D, C>::correct(const T* residual, T* x) {
  using Values = Eigen::Array<T, C, 1>;
  Level& above = levels_.front();
  for_each_row(above.size(), threads_, [&](std::size_t c) {
    Value sum = Value::Zero();
    for (std::uint32_t i = above.child_first[c]; i < above.child_first[c + 1]; ++i)
      sum += Eigen::Map<const Values>(residual + std::size_t(i) * C).template cast<float>();
    above.b[c] = sum;
  });
  cycle(0, true);
  if (levels_.size() > 1) cycle(0, false);
  for_each_row(size_, threads_, [&](std::size_t i) {
    if (diagonal_[i] > 0)
      Eigen::Map<Values>(x + i * C) += (first_enlargement * above.x[parent_[i]]).template cast<T>();
  });
}

template <int D, int C>
void Multigrid<D, C>::apply(const double* r, double* z) {
  const PairRows rows{lists_->first(), lists_->index()};
  const auto find_residual = [&] {
    parallel_pieces(std::ptrdiff_t(size_), threads_, rows_in_piece,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      kernels_.residual(rows, weight_, diagonal_.data(), x_.data(), b_.data(),
                                        r_.data(), begin, end);
                    });
  };
  for_each_row(size_, threads_, [&](std::size_t i) {
    b_[i] = diagonal_[i] > 0 ? float(r[i]) : 0.0f;
    x_[i] = inverse_[i] * b_[i];
  });
  find_residual();
  correct(r_.data(), x_.data());
  find_residual();
  for_each_row(size_, threads_, [&](std::size_t i) { z[i] = double(x_[i] + inverse_[i] * r_[i]); });
}

template <int D, int C>
std::size_t Multigrid<D, C>::bytes() const {
  std::size_t total = size_ * (5 * sizeof(float) + sizeof(std::uint32_t));
  for (const Level& level : levels_)
    total += level.size() *
             (stencil * (sizeof(float) + sizeof(std::int32_t)) + (7 + 3 * C) * sizeof(float));
  return total;
}

template class Multigrid<2, 1>;
template class Multigrid<2, 2>;
template class Multigrid<3, 1>;
template class Multigrid<3, 3>;
template void Multigrid<2, 2>::correct(const double*, double*);
template void Multigrid<3, 3>::correct(const double*, double*);

}  // namespace snowshed::methods::mps
