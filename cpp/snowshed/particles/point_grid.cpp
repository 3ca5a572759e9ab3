#include "snowshed/particles/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snowshed::particles {

PointGrid::PointGrid(const std::vector<Vec3>& points, double edge, const StopRequest& stop)
    : edge_(edge), y_reach_(0) {
  StopCheck check_stop(stop);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) {
    keyed[n] = {key(cell_of(points[n])), static_cast<std::uint32_t>(n)};
    if (points[n].y() != 0) y_reach_ = 1;
  }
  std::sort(keyed.begin(), keyed.end(), [&](const auto& a, const auto& b) {
    check_stop();
    return a < b;
  });

  std::size_t cells = 0;
  for (std::size_t n = 0; n < keyed.size(); ++n)
    cells += n == 0 || keyed[n].first != keyed[n - 1].first;
  std::size_t slots = 2;
  while (slots < 2 * cells) slots *= 2;
  table_.resize(slots);

  sorted_.reserve(keyed.size());
  for (std::size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
    check_stop();
    for (; end < keyed.size() && keyed[end].first == keyed[begin].first; ++end)
      sorted_.push_back({points[keyed[end].second], keyed[end].second});
    const std::uint64_t key = keyed[begin].first;
    table_[slot_of(key)] = {key, static_cast<std::uint32_t>(begin),
                            static_cast<std::uint32_t>(end)};
  }
}

PointGrid::Cell PointGrid::cell_of(const Vec3& x) const {
  const auto index = [this](double coordinate) {
    return static_cast<std::int64_t>(std::floor(coordinate / edge_));
  };
  return {index(x.x()), index(x.y()), index(x.z())};
}

}  // namespace snowshed::particles
