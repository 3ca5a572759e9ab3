#include "snowshed/methods/mps/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snowshed::methods::mps {
namespace {

/// Number of particles in a box; consecutive particles are close to each other.
constexpr std::size_t particles_in_box = 64;

struct PointBox {
  Vec3 low, high;
};

template <int D>
PointBox box_around(const AlignedVector<VecD<D>>& points, std::size_t begin, std::size_t end) {
  PointBox box{embed(points[begin]), embed(points[begin])};
  for (std::size_t i = begin + 1; i < end; ++i) {
    box.low = box.low.cwiseMin(embed(points[i]));
    box.high = box.high.cwiseMax(embed(points[i]));
  }
  return box;
}

/// Whether points in a box may be within reach of an obstacle.
bool may_touch(const PlacedObstacle& o, const PointBox& box, double reach, int dimension) {
  if (!o.obstacle->motion) {
    const geometry::Bounds bounds = o.obstacle->shape->bounds();
    for (const int d : {0, 1, 2}) {
      if (d == 1 && dimension == 2) continue;
      if (bounds.min[d] - reach > box.high[d] || bounds.max[d] + reach < box.low[d]) return false;
    }
  }
  return o.distance(0.5 * (box.low + box.high)) < 0.5 * (box.high - box.low).norm() + reach;
}

}  // namespace

geometry::ThickSolid thickened_for_particles(geometry::Shape shape, double spacing, int dimension) {
  if (shape->is_convex()) return {std::move(shape), std::nullopt};
  return geometry::thickened(std::move(shape), spacing, dimension);
}

std::vector<PlacedObstacle> place_obstacles(const std::vector<Obstacle>& obstacles, double time) {
  std::vector<PlacedObstacle> placed;
  for (std::uint32_t k = 0; k < obstacles.size(); ++k) {
    const Obstacle& o = obstacles[k];
    placed.push_back({&o, k, o.motion ? o.motion->at(time) : geometry::RigidPose{}});
  }
  return placed;
}

template <int D>
void find_contacts(const std::vector<Obstacle>& obstacles, double reach,
                   const Particles<D>& particles, double time, int threads,
                   RowLists<WallContact<D>>& contacts) {
  const std::vector<PlacedObstacle> placed = place_obstacles(obstacles, time);
  const AlignedVector<VecD<D>>& points = particles.position;
  contacts.update(
      points.size(), particles_in_box, threads,
      [&](std::size_t begin, std::size_t end, std::uint32_t* first,
          std::vector<WallContact<D>>& list) {
        const PointBox box = box_around(points, begin, end);
        std::vector<const PlacedObstacle*> near;
        for (const PlacedObstacle& o : placed)
          if (may_touch(o, box, reach, D)) near.push_back(&o);
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t before = list.size();
          const Vec3 x = embed(points[i]);
          if (!particles.is_wall(i))
            for (const PlacedObstacle* o : near) {
              const double distance = o->distance(x);
              if (distance >= reach) continue;
              const VecD<D> normal = section<D>(o->normal(x));
              if (!(normal.squaredNorm() > 1e-12))
                continue;  // surface parallel to the plane (x, z)
              VecD<D> velocity = VecD<D>::Zero();
              if (o->obstacle->motion) velocity = section<D>(o->pose.velocity(x));
              list.push_back({o->number, distance, o->thickness(x), normal.normalized(), velocity});
            }
          first[i + 1] = std::uint32_t(list.size() - before);
        }
      });
}

template <int D>
double largest_wall_speed(const RowLists<WallContact<D>>& contacts) {
  double fastest2 = 0;
  for (const WallContact<D>& c : contacts.all())
    fastest2 = std::max(fastest2, c.velocity.squaredNorm());
  return std::sqrt(fastest2);
}

template void find_contacts(const std::vector<Obstacle>&, double, const Particles<2>&, double, int,
                            RowLists<WallContact<2>>&);
template void find_contacts(const std::vector<Obstacle>&, double, const Particles<3>&, double, int,
                            RowLists<WallContact<3>>&);
template double largest_wall_speed(const RowLists<WallContact<2>>&);
template double largest_wall_speed(const RowLists<WallContact<3>>&);

}  // namespace snowshed::methods::mps
