#include "snowshed/geometry/nearest_seed.hpp"

#include <algorithm>

namespace snowshed::geometry {

NearestSeed::NearestSeed(const Vec3& origin, double spacing,
                         const std::array<std::size_t, 3>& counts)
    : origin_(origin),
      spacing_(spacing),
      counts_{std::int64_t(counts[0]), std::int64_t(counts[1]), std::int64_t(counts[2])},
      nearest_(counts[0] * counts[1] * counts[2], none) {}

void NearestSeed::propagate(const std::vector<Vec3>& seeds) {
  seeds_ = &seeds;
  std::fill(nearest_.begin(), nearest_.end(), none);
  for (std::uint32_t s = 0; s < seeds.size(); ++s) offer_to_cell(s);
  for (int sweep = 0; sweep < 8; ++sweep)
    this->sweep(sweep & 1 ? -1 : 1, sweep & 2 ? -1 : 1, sweep & 4 ? -1 : 1);
}

void NearestSeed::offer(const Index& n, std::uint32_t seed) {
  std::uint32_t& nearest = nearest_[at(n)];
  if (seed == none || seed == nearest) return;
  const Vec3 x = position(n);
  if (nearest == none ||
      ((*seeds_)[seed] - x).squaredNorm() < ((*seeds_)[nearest] - x).squaredNorm())
    nearest = seed;
}

void NearestSeed::offer_to_cell(std::uint32_t seed) {
  const Index low = cell_of((*seeds_)[seed]);
  for (int corner = 0; corner < 8; ++corner) {
    const Index n{low.i + (corner & 1), low.j + (corner >> 1 & 1), low.k + (corner >> 2 & 1)};
    if (contains(n)) offer(n, seed);
  }
}

/// Visits the nodes in the direction of the sweep, each one after its neighbours upstream.
void NearestSeed::sweep(int di, int dj, int dk) {
  const auto start = [](int d, std::int64_t n) { return d > 0 ? 0 : n - 1; };
  Index n;
  for (n.i = start(di, counts_[0]); n.i >= 0 && n.i < counts_[0]; n.i += di)
    for (n.j = start(dj, counts_[1]); n.j >= 0 && n.j < counts_[1]; n.j += dj)
      for (n.k = start(dk, counts_[2]); n.k >= 0 && n.k < counts_[2]; n.k += dk)
        for (const Index& from :
             {Index{n.i - di, n.j, n.k}, {n.i, n.j - dj, n.k}, {n.i, n.j, n.k - dk}})
          if (contains(from)) offer(n, nearest_[at(from)]);
}

std::vector<Vec3> zero_crossings(const NearestSeed& grid, const std::vector<float>& values) {
  using Index = NearestSeed::Index;
  std::vector<Vec3> crossings;
  grid.for_each_edge([&](const Index& n, const Index& next) {
    const double a = values[grid.at(n)], b = values[grid.at(next)];
    if ((a < 0) == (b < 0)) return;
    const Vec3 from = grid.position(n), to = grid.position(next);
    crossings.push_back(from + a / (a - b) * (to - from));
  });
  return crossings;
}

}  // namespace snowshed::geometry
