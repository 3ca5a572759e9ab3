#include "snowshed/methods/mpm/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mpm {

geometry::ThickSolid thickened_for_grid(geometry::Shape shape, double dx, int dimension) {
  return geometry::thickened(std::move(shape), dx, dimension);
}

Obstacle thickened_obstacle(Obstacle obstacle, double dx, int dimension) {
  obstacle.shape = thickened_for_grid(std::move(obstacle.shape), dx, dimension).shape;
  return obstacle;
}

template <class T, int D>
Boundary<T, D>::Boundary(std::vector<Obstacle> obstacles, double dx,
                         std::vector<geometry::Shape> surfaces, double margin, bool records_forces)
    : surfaces_(std::move(surfaces)), dx_(dx), margin_(margin), records_forces_(records_forces) {
  if (surfaces_.empty())
    for (const Obstacle& o : obstacles) surfaces_.push_back(o.shape);
  for (Obstacle& o : obstacles) {
    laws_.push_back(o.law);
    any_motion_ = any_motion_ || o.motion.has_value();
    obstacles_.push_back(thickened_obstacle(std::move(o), dx, D));
  }
}

namespace {

template <int D>
VecD<D> block_center(const BlockCoord<D>& block, double dx) {
  constexpr int B = block_edge<D>;
  VecD<D> x;
  for (int d = 0; d < D; ++d) x[d] = (block[d] * B + 0.5 * (B - 1)) * dx;
  return x;
}

}  // namespace

template <class T, int D>
void Boundary<T, D>::find(BlockKey key, double time, bool moving,
                          std::vector<Contact<T>>& contacts) const {
  const BlockCoord<D> block = block_coord<D>(key);
  const double reach = 0.5 * block_edge<D> * dx_ * std::sqrt(double(D));
  const double on_surface = 1e-6 * dx_;  // a node on the surface belongs to the obstacle
  for (std::size_t o = 0; o < obstacles_.size(); ++o) {
    const Obstacle& obstacle = obstacles_[o];
    if (obstacle.motion.has_value() != moving) continue;
    const geometry::RigidPose pose = moving ? obstacle.motion->at(time) : geometry::RigidPose{};
    const auto local = [&](const Vec3& x) { return moving ? pose.to_body(x) : x; };
    if (obstacle.shape->distance(local(embed(block_center<D>(block, dx_)))) > reach + margin_)
      continue;
    for (int node = 0; node < block_nodes<D>; ++node) {
      const Vec3 x = embed(node_position<D>(block, node, dx_));
      const Vec3 body = local(x);
      if (!(obstacle.shape->distance(body) <= on_surface) &&
          !(margin_ > 0 && surfaces_[o]->distance(body) <= margin_))
        continue;
      Vec3 normal = obstacle.shape->normal(body);
      if (moving) normal = pose.normal_to_world(normal);
      const VecD<D> n = normal_in_section<D>(normal);
      const VecD<D> v = section<D>(moving ? pose.velocity(x) : Vec3::Zero());
      Contact<T> c{};
      c.node = node;
      c.obstacle = std::int32_t(o);
      for (int d = 0; d < D; ++d) {
        c.normal[d] = c.outward[d] = T(n[d]);
        c.velocity[d] = T(v[d]);
      }
      c.release = release(obstacle.law.condition, n[D - 1]);
      contacts.push_back(c);
    }
  }
}

template <class T, int D>
typename Boundary<T, D>::FacePoint Boundary<T, D>::face_point(BlockKey key, const Contact<T>& c,
                                                              double time) const {
  const Obstacle& obstacle = obstacles_[std::size_t(c.obstacle)];
  const geometry::LevelSet& surface = *surfaces_[std::size_t(c.obstacle)];
  Vec3 x = embed(node_position<D>(block_coord<D>(key), c.node, dx_));
  if (obstacle.motion) x = obstacle.motion->to_body(x, time);
  const Vec3 normal = embed(normal_in_section<D>(surface.normal(x)));
  return {x - surface.distance(x) * normal, normal};
}

template <class T, int D>
template <class Find>
Contacts<T, D> Contacts<T, D>::gathered(const Boundary<T, D>& boundary,
                                        const std::vector<BlockKey>& blocks, int threads,
                                        Find find) {
  std::vector<OfBlock> by_block(blocks.size());
  parallel_for_dynamic(std::ptrdiff_t(blocks.size()), threads, 8, [&](std::ptrdiff_t b) {
    find(std::size_t(b), by_block[b]);
    if (boundary.records_forces()) by_block[b].forces.resize(by_block[b].contacts.size());
  });
  Contacts all;
  all.blocks_ = blocks;
  all.first_.reserve(blocks.size() + 1);
  for (const OfBlock& block : by_block) {
    all.contacts_.insert(all.contacts_.end(), block.contacts.begin(), block.contacts.end());
    all.forces_.insert(all.forces_.end(), block.forces.begin(), block.forces.end());
    all.first_.push_back(all.contacts_.size());
    if (!boundary.records_forces()) continue;
    const bool one = !block.contacts.empty() &&
                     block.contacts.front().obstacle == block.contacts.back().obstacle;
    all.only_.push_back(block.contacts.empty() ? -1 : one ? block.contacts.front().obstacle : -2);
  }
  return all;
}

template <class T, int D>
Contacts<T, D> Contacts<T, D>::relocated(const Boundary<T, D>& boundary,
                                         const std::vector<BlockKey>& grid_blocks, double time,
                                         int threads) const {
  return gathered(boundary, grid_blocks, threads, [&](std::size_t b, OfBlock& of_block) {
    const auto old = std::lower_bound(blocks_.begin(), blocks_.end(), grid_blocks[b]);
    if (old != blocks_.end() && *old == grid_blocks[b]) {
      const auto begin = std::ptrdiff_t(first_[std::size_t(old - blocks_.begin())]);
      const auto end = std::ptrdiff_t(first_[std::size_t(old - blocks_.begin()) + 1]);
      of_block.contacts.assign(contacts_.begin() + begin, contacts_.begin() + end);
      if (!forces_.empty()) of_block.forces.assign(forces_.begin() + begin, forces_.begin() + end);
    } else {
      boundary.find(grid_blocks[b], time, false, of_block.contacts);
      if (boundary.any_motion()) boundary.find(grid_blocks[b], time, true, of_block.contacts);
    }
  });
}

template <class T, int D>
void Contacts<T, D>::follow(const Boundary<T, D>& boundary, double time, int threads) {
  if (!boundary.any_motion()) return;
  *this = gathered(boundary, blocks_, threads, [&](std::size_t b, OfBlock& of_block) {
    const auto keep = [&](std::size_t old) {
      of_block.contacts.push_back(contacts_[old]);
      if (!forces_.empty()) of_block.forces.push_back(forces_[old]);
    };
    for (std::size_t i = first_[b]; i < first_[b + 1]; ++i)
      if (!boundary.is_moving(contacts_[i])) keep(i);
    const std::size_t still = of_block.contacts.size();
    boundary.find(blocks_[b], time, true, of_block.contacts);
    if (boundary.records_forces()) of_block.forces.resize(of_block.contacts.size());
    for (std::size_t i = still; i < of_block.contacts.size(); ++i) {
      Contact<T>& c = of_block.contacts[i];
      for (std::size_t old = first_[b]; old < first_[b + 1]; ++old) {
        const Contact<T>& before = contacts_[old];
        if (before.node != c.node || before.obstacle != c.obstacle) continue;
        c.normal_impulse = c.next_normal_impulse = before.next_normal_impulse;
        if (forces_.empty()) continue;
        of_block.forces[i] = forces_[old];
        of_block.forces[i].patch = -1;  // the obstacle has moved past the node
      }
    }
  });
}

template <class T, int D>
void Contacts<T, D>::find_patches(const Boundary<T, D>& boundary, double time,
                                  PressureMap& pressures) {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (std::size_t i = first_[b]; i < first_[b + 1]; ++i) {
      if (forces_[i].patch >= 0) continue;
      const auto face = boundary.face_point(blocks_[b], contacts_[i], time);
      forces_[i].patch = pressures.patch_at(contacts_[i].obstacle, face.point, face.normal);
    }
}

template <class T, int D>
bool Contacts<T, D>::moves(std::size_t block) const {
  const auto in_motion = [](const Contact<T>& c) {
    return std::any_of(c.velocity, c.velocity + D, [](T v) { return v != T(0); });
  };
  return std::any_of(contacts_.begin() + first_[block], contacts_.begin() + first_[block + 1],
                     in_motion);
}

template <class T, int D>
void Contacts<T, D>::find_friction_shares(FrictionShares<T>& result) const {
  std::fill(result.positive_impulses.begin(), result.positive_impulses.end(), T(0));
  std::fill(result.shares.begin(), result.shares.end(), T(0));
  for (const Contact<T>& c : contacts_) {
    if (c.release != Release::never) continue;
    result.positive_impulses[c.obstacle] += std::max(c.next_normal_impulse, T(0));
    result.shares[c.obstacle] += c.next_normal_impulse;
  }
  for (std::size_t i = 0; i < result.shares.size(); ++i)
    result.shares[i] = result.positive_impulses[i] > 0
                           ? std::max(result.shares[i], T(0)) / result.positive_impulses[i]
                           : T(1);
}

template <class T, int D>
std::vector<typename Contacts<T, D>::StoredImpulse> Contacts<T, D>::stored_impulses() const {
  std::vector<StoredImpulse> stored;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (std::size_t i = first_[b]; i < first_[b + 1]; ++i)
      if (contacts_[i].next_normal_impulse != T(0))
        stored.push_back({blocks_[b], contacts_[i].node, contacts_[i].obstacle,
                          double(contacts_[i].next_normal_impulse)});
  return stored;
}

template <class T, int D>
template <class Stored, class F>
void Contacts<T, D>::for_each_stored(const std::vector<Stored>& stored, const F& f) {
  for (const Stored& d : stored) {
    const auto at = std::lower_bound(blocks_.begin(), blocks_.end(), d.block);
    if (at == blocks_.end() || *at != d.block) continue;
    const std::size_t b = std::size_t(at - blocks_.begin());
    for (std::size_t i = first_[b]; i < first_[b + 1]; ++i)
      if (contacts_[i].node == d.node && contacts_[i].obstacle == d.obstacle) f(i, d);
  }
}

template <class T, int D>
void Contacts<T, D>::restore(const std::vector<StoredImpulse>& stored) {
  for_each_stored(stored, [&](std::size_t i, const StoredImpulse& d) {
    contacts_[i].normal_impulse = contacts_[i].next_normal_impulse = T(d.amount);
  });
}

template <class T, int D>
std::vector<typename Contacts<T, D>::StoredForce> Contacts<T, D>::stored_forces() const {
  std::vector<StoredForce> stored;
  if (forces_.empty()) return stored;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (std::size_t i = first_[b]; i < first_[b + 1]; ++i) {
      ContactForce<T> f = forces_[i];
      sum_impulse(f);
      if (f.age == T(0) && is_empty(f)) continue;
      stored.push_back({blocks_[b],
                        contacts_[i].node,
                        contacts_[i].obstacle,
                        {double(f.sum[0]), double(f.sum[1]), double(f.sum[2])},
                        {double(f.mean[0]), double(f.mean[1]), double(f.mean[2])},
                        double(f.age)});
    }
  return stored;
}

template <class T, int D>
void Contacts<T, D>::restore(const std::vector<StoredForce>& stored) {
  if (forces_.empty()) return;
  for_each_stored(stored, [&](std::size_t i, const StoredForce& d) {
    for (int k = 0; k < 3; ++k) {
      forces_[i].sum[k] = T(d.sum[std::size_t(k)]);
      forces_[i].mean[k] = T(d.mean[std::size_t(k)]);
    }
    forces_[i].age = T(d.age);
  });
}

template class Boundary<float, 2>;
template class Boundary<float, 3>;
template class Boundary<double, 2>;
template class Boundary<double, 3>;
template class Contacts<float, 2>;
template class Contacts<float, 3>;
template class Contacts<double, 2>;
template class Contacts<double, 3>;

}  // namespace snowshed::methods::mpm
