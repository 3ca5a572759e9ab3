#include "snowshed/methods/mps/wall_particles.hpp"

#include <algorithm>
#include <cmath>

namespace snowshed::methods::mps {
namespace {

/// Wall particles nearer to each other than this (in l0) push each other apart, in this number of
/// rounds.
constexpr double min_separation = 0.8;
constexpr int push_rounds = 8;
/// Tolerance of the depth of a layer's middle, in l0; a solid that is not deep enough lacks the
/// layer.
constexpr double layer_tolerance = 0.25;

Mat3 frame_with(const Vec3& normal, int dimension) {
  Mat3 axes;
  Vec3 along =
      dimension == 2 ? Vec3(normal.z(), 0, -normal.x()) : Vec3(Vec3::UnitX() - normal.x() * normal);
  if (along.squaredNorm() < 1e-6) along = Vec3::UnitY();
  axes.col(0) = along.normalized();
  axes.col(2) = normal;
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

bool is_bounded(const geometry::Bounds& bounds, int dimension) {
  for (const int d : {0, 1, 2})
    if (!(dimension == 2 && d == 1) &&
        !(std::isfinite(bounds.min[d]) && std::isfinite(bounds.max[d])))
      return false;
  return true;
}

/// Calls f with every cell whose coordinates differ from `at` by at most `rings`, in a fixed order.
template <std::size_t D, class F>
void for_cells_around(const std::array<std::int32_t, D>& at, int rings, const F& f) {
  std::array<std::int32_t, D> c{};
  const int side = 2 * rings + 1;
  int count = 1;
  for (std::size_t d = 0; d < D; ++d) count *= side;
  for (int k = 0; k < count; ++k) {
    int rest = k;
    for (std::size_t d = 0; d < D; ++d) {
      c[d] = at[d] + rest % side - rings;
      rest /= side;
    }
    f(c);
  }
}

template <int D>
std::array<std::int32_t, D> cell_of(const VecD<D>& x, double edge) {
  std::array<std::int32_t, D> c;
  for (int d = 0; d < D; ++d) c[std::size_t(d)] = std::int32_t(std::floor(x[d] / edge));
  return c;
}

template <std::size_t D>
void sort_and_unite(std::vector<std::array<std::int32_t, D>>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

/// The cells that contain points or, near the ends of a period, their repetitions.
template <int D>
std::vector<std::array<std::int32_t, D>> cells_with(const AlignedVector<VecD<D>>& points,
                                                    double edge, double period) {
  std::vector<std::array<std::int32_t, D>> cells;
  const auto add = [&](const VecD<D>& x) {
    const auto c = cell_of<D>(x, edge);
    if (cells.empty() || cells.back() != c) cells.push_back(c);
  };
  for (const VecD<D>& x : points) {
    add(x);
    if (period <= 0) continue;
    VecD<D> shifted = x;
    if (x[0] < 3 * edge) shifted[0] = x[0] + period;
    if (x[0] > period - 3 * edge) shifted[0] = x[0] - period;
    add(shifted);
  }
  sort_and_unite(cells);
  return cells;
}

}  // namespace

template <int D>
std::size_t WallParticles<D>::Hash::operator()(const Cell& c) const {
  std::size_t h = 0;
  for (const std::int32_t k : c) h = h * 0x9e3779b97f4a7c15u + std::uint32_t(k);
  return h ^ (h >> 29);
}

template <int D>
WallParticles<D>::WallParticles(const std::vector<Obstacle>& obstacles, double spacing,
                                double reach)
    : obstacles_(&obstacles),
      spacing_(spacing),
      edge_(reach),
      layers_(int(std::ceil(reach / spacing - 1e-9))) {
  groups_.emplace_back();
  for (std::uint32_t k = 0; k < obstacles.size(); ++k) {
    const geometry::LevelSet& shape = *obstacles[k].shape;
    Lattice lattice;
    if (const auto box = shape.oriented_box()) {
      Vec3 half = box->half;
      if (D == 2) half.y() = 0;
      lattice.axes = box->axes;
      lattice.origin = box->center - box->axes * half;
    } else if (!is_bounded(shape.bounds(), D)) {
      const Vec3 normal = shape.normal(Vec3::Zero());
      lattice.axes = frame_with(normal, D);
      lattice.origin = -shape.distance(Vec3::Zero()) * normal;
    }
    lattices_.push_back(std::move(lattice));
    if (obstacles[k].motion)
      groups_.push_back({{k}, {}, {}});
    else
      groups_.front().obstacles.push_back(k);
  }
}

/// Moves points that lie too near to each other along their layers.
template <int D>
void WallParticles<D>::push_apart(const geometry::LevelSet& shape, std::vector<VecD<D>>& points,
                                  const std::vector<double>& depth) const {
  const double limit = min_separation * spacing_;
  std::vector<VecD<D>> shift(points.size());
  for (int push = 0; push < push_rounds; ++push) {
    bool any = false;
    std::fill(shift.begin(), shift.end(), VecD<D>(VecD<D>::Zero()));
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t j = i + 1; j < points.size(); ++j) {
        const VecD<D> r = points[j] - points[i];
        const double distance = r.norm();
        if (!(distance < limit) || distance == 0) continue;
        const VecD<D> half = 0.5 * (limit - distance) / distance * r;
        shift[i] -= half;
        shift[j] += half;
        any = true;
      }
    if (!any) return;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (shift[i].isZero()) continue;
      const Vec3 moved = embed(VecD<D>(points[i] + shift[i]));
      points[i] =
          section<D>(Vec3(moved - (shape.distance(moved) + depth[i]) * shape.normal(moved)));
    }
  }
}

/// The new position of a point of a lattice, if it lies in a layer.
template <int D>
typename WallParticles<D>::LayerPoint WallParticles<D>::place(const geometry::LevelSet& shape,
                                                              const Vec3& x) const {
  const double distance = shape.distance(x), thin = shape.half_thickness(x);
  double target = thin;
  if (thin >= 0.5 * spacing_) {
    if (!(distance < 0) || !(distance >= -layers_ * spacing_)) return {};
    target = (std::min(std::floor(-distance / spacing_), layers_ - 1.0) + 0.5) * spacing_;
  } else if (!(distance + thin < 0.5 * spacing_)) {
    return {};
  }
  const Vec3 normal = shape.normal(x);
  if (!(section<D>(normal).squaredNorm() > 1e-12)) return {};
  const Vec3 moved = x - (distance + target) * normal;
  if (std::abs(shape.distance(moved) + target) > layer_tolerance * spacing_) return {};
  return {true, section<D>(moved), target};
}

/// Makes the particles whose lattice points lie in a cell.
template <int D>
void WallParticles<D>::make(std::uint32_t number, const Cell& cell, Points& to) {
  const geometry::LevelSet& shape = *(*obstacles_)[number].shape;
  Lattice& lattice = lattices_[number];
  VecD<D> corner;
  for (int d = 0; d < D; ++d) corner[d] = cell[std::size_t(d)] * edge_;
  const Vec3 middle = embed(VecD<D>(corner + 0.5 * edge_ * VecD<D>::Ones()));
  // The lattice points in the ball around the cell and those near to it.
  const double around = edge_ * std::sqrt(double(D)) / 2 + 1.5 * spacing_;
  const double deepest = layers_ * spacing_;
  const double distance = shape.distance(middle);
  if (distance > around + spacing_ || (distance < -deepest - around)) return;
  const Vec3 center = lattice.axes.transpose() * (middle - lattice.origin) / spacing_;
  const int n = int(std::ceil(around / spacing_)) + 1;
  std::vector<VecD<D>> points;
  std::vector<double> depth;
  std::vector<std::uint8_t> own;
  for_cells_around(cell_of<D>(section<D>(center), 1.0), n, [&](const Cell& k) {
    VecD<D> index;
    for (int d = 0; d < D; ++d) index[d] = k[std::size_t(d)] + 0.5;
    const Vec3 x = lattice.origin + spacing_ * (lattice.axes * embed(index));
    if ((x - middle).norm() > around) return;
    const auto [entry, is_new] = lattice.placed.try_emplace(k);
    LayerPoint& placed = entry->second;
    if (is_new) placed = place(shape, x);
    if (!placed.exists) return;
    points.push_back(placed.position);
    depth.push_back(placed.depth);
    own.push_back(cell_of<D>(section<D>(x), edge_) == cell);
  });
  push_apart(shape, points, depth);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!own[i]) continue;
    const Vec3 x = embed(points[i]);
    const bool has_inner = 2 * shape.half_thickness(x) >= edge_ + spacing_;
    const VecD<D> normal = section<D>(shape.normal(x)).stableNormalized();
    to.push_back({points[i], normal, number,
                  has_inner && depth[i] < spacing_ ? Kind::inner_wall : Kind::dummy_wall});
  }
}

/// If obstacles of a group overlap, the first one has the wall particles there. A particle's normal
/// is that of the obstacle in which it is deepest, as for the union of all; it is zero if two
/// obstacles with different normals are equally deep.
template <int D>
const typename WallParticles<D>::Points& WallParticles<D>::points_in(Group& group,
                                                                     const Cell& cell) {
  const auto entry = group.made.find(cell);
  if (entry != group.made.end()) return entry->second;
  Points all, points;
  for (const std::uint32_t k : group.obstacles) make(k, cell, all);
  for (Point& p : all) {
    const Vec3 x = embed(p.position);
    double deepest = -(*obstacles_)[p.obstacle].shape->distance(x);
    bool is_first = true;
    for (const std::uint32_t k : group.obstacles) {
      const double depth = k == p.obstacle ? 0.0 : -(*obstacles_)[k].shape->distance(x);
      if (!(depth > 0)) continue;
      is_first = is_first && k > p.obstacle;
      const VecD<D> normal = section<D>((*obstacles_)[k].shape->normal(x)).stableNormalized();
      if (depth > deepest + layer_tolerance * spacing_) {
        p.normal = normal;
        deepest = depth;
      } else if (depth > deepest - layer_tolerance * spacing_ && normal.dot(p.normal) < 0.7) {
        p.normal.setZero();
      }
    }
    if (deepest > spacing_) p.kind = Kind::dummy_wall;
    if (is_first) points.push_back(p);
  }
  return group.made.emplace(cell, std::move(points)).first->second;
}

template <int D>
bool WallParticles<D>::is_near_wall(Group& group, const Cell& cell) {
  const auto entry = group.near.find(cell);
  if (entry != group.near.end()) return entry->second;
  bool near = false;
  VecD<D> center;
  for (int d = 0; d < D; ++d) center[d] = (cell[std::size_t(d)] + 0.5) * edge_;
  for (const std::uint32_t k : group.obstacles)
    near = near || (*obstacles_)[k].shape->distance(embed(center)) < 4 * edge_;
  if (near) {
    near = false;
    for_cells_around(cell, 2, [&](const Cell& c) { near = near || !points_in(group, c).empty(); });
  }
  group.near.emplace(cell, near);
  return near;
}

template <int D>
void WallParticles<D>::append_group(Group& group, const geometry::RigidPose& pose, double period,
                                    const std::vector<Cell>& snow_cells, double mass,
                                    Particles<D>& to) {
  std::vector<Cell> cells;
  for (const Cell& c : snow_cells)
    if (is_near_wall(group, c)) for_cells_around(c, 2, [&](const Cell& k) { cells.push_back(k); });
  sort_and_unite(cells);
  const bool moves = &group != &groups_.front();
  for (const Cell& c : cells)
    for (const Point& p : points_in(group, c)) {
      const VecD<D> x = moves ? section<D>(pose.to_world(embed(p.position))) : p.position;
      if (period > 0 && (x[0] < 0 || x[0] >= period)) continue;
      bool inside = false;  // inside an obstacle at rest
      if (moves)
        for (const std::uint32_t k : groups_.front().obstacles)
          inside = inside || (*obstacles_)[k].shape->distance(embed(x)) < 0;
      if (inside) continue;
      const std::size_t i = to.size();
      to.resize(i + 1);
      to.position[i] = x;
      to.velocity[i] = moves ? section<D>(pose.velocity(embed(x))) : VecD<D>(VecD<D>::Zero());
      to.pressure[i] = to.shear_rate[i] = to.viscosity[i] = 0;
      to.mass[i] = mass;
      to.relative_density[i] = 1;
      to.pressure_acceleration[i] =
          moves ? section<D>(pose.normal_to_world(embed(p.normal))) : p.normal;
      to.viscous_acceleration[i].setZero();
      to.elastic_strain[i].setZero();
      to.elastic_slip[i].setZero();
      to.kind[i] = p.kind;
      to.id[i] = 0xffffffff;
      to.event[i] = std::uint16_t(p.obstacle);
    }
}

template <int D>
void WallParticles<D>::append_near(double time, double period, double mass, Particles<D>& snow) {
  const AlignedVector<VecD<D>> points = snow.position;
  for (Group& group : groups_) {
    if (group.obstacles.empty()) continue;
    const bool moves = &group != &groups_.front();
    geometry::RigidPose pose;
    AlignedVector<VecD<D>> seen;  // positions in the frame of a moving group
    if (moves) {
      pose = (*obstacles_)[group.obstacles.front()].motion->at(time);
      seen = points;
      for (VecD<D>& x : seen) x = section<D>(pose.to_body(embed(x)));
    }
    const auto cells = cells_with<D>(moves ? seen : points, edge_, period);
    append_group(group, pose, period, cells, mass, snow);
  }
}

template <int D>
std::size_t WallParticles<D>::bytes() const {
  std::size_t total = 0;
  for (const Group& group : groups_)
    for (const auto& cell : group.made)
      total += sizeof(cell) + cell.second.capacity() * sizeof(Point);
  for (const Lattice& lattice : lattices_)
    total += lattice.placed.size() * sizeof(std::pair<const Cell, LayerPoint>);
  return total;
}

template <int D>
void remove_walls(Particles<D>& particles) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.is_wall(i)) continue;
    if (count != i)
      particles.for_each_array([&](const char*, auto& array) { array[count] = array[i]; });
    ++count;
  }
  particles.resize(count);
}

template class WallParticles<2>;
template class WallParticles<3>;
template void remove_walls(Particles<2>&);
template void remove_walls(Particles<3>&);

}  // namespace snowshed::methods::mps
