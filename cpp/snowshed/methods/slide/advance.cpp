#include "snowshed/methods/slide/advance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace snowshed {
namespace {

constexpr double least_speed = 1e-6;  // m/s

/// A velocity after friction, and for how long the particle moves, s.
struct Slowed {
  Vec3 velocity;
  double moving;
};

/// Coulomb friction as a set-valued law: it stops snow, and holds it where what drives it is less.
/// The part that grows with the square of the speed is implicit: s' + drag dt s'^2 = s.
Slowed slowed(const SlideLoad& load, const Vec3& u, double dt) {
  const double speed = u.norm(), rest = speed - dt * load.yield;
  if (rest <= 0) return {Vec3::Zero(), dt};
  const double after = 2 * rest / (1 + std::sqrt(1 + 4 * load.drag * dt * rest));
  return {u * (after / speed), dt};
}

/// As AvaFrame does it by default: a rate that divides by the speed of before.
Slowed slowed_implicitly(const SlideLoad& load, const Vec3& u, double dt) {
  const double stress = load.yield + load.drag * load.speed * load.speed;  // m/s2
  return {u / (1 + dt * stress / std::max(load.speed, least_speed)), dt};
}

Slowed slowed_explicitly(const SlideLoad& load, const Vec3& u, double dt) {
  const double stress = load.yield + load.drag * load.speed * load.speed, speed = u.norm();
  if (speed >= dt * stress) return {u - u * (dt * stress / std::max(speed, 1e-300)), dt};
  return {Vec3::Zero(), load.speed > 0 ? speed / stress : 0.0};
}

Slowed slowed_by(const SlideModel& model, const SlideLoad& load, const Vec3& u) {
  const double dt = model.settings.time_step;
  if (!model.compatible()) return slowed(load, u, dt);
  return model.settings.explicit_friction ? slowed_explicitly(load, u, dt)
                                          : slowed_implicitly(load, u, dt);
}

/// The velocity along the ground, at its speed of before.
Vec3 along_ground(const Vec3& u, const Vec3& normal, double added_speed) {
  const Vec3 tangential = u - u.dot(normal) * normal;
  const double speed = tangential.norm();
  return speed > 0 ? Vec3(tangential * (u.norm() / (speed + added_speed))) : tangential;
}

}  // namespace

void advance(const SlideModel& model, SlideState& state, SlideWork& work) {
  SlideParticles& p = state.particles;
  const Terrain& terrain = model.terrain;
  const double dt = model.settings.time_step;
  const double added_speed = model.compatible() ? least_speed : 0.0;
  std::fill(work.removed.begin(), work.removed.end(), 0);
  const auto move = [&](std::size_t i) {  // returns the kinetic energy, J
    const SlideLoad& load = work.loads[i];
    const Vec3 before{p.ux[i], p.uy[i], p.uz[i]};
    const Vec3 pushed = before + dt * (load.acceleration + load.force / p.mass[i]);
    const Slowed s = slowed_by(model, load, pushed);
    const Vec3 way = 0.5 * s.moving * (before + s.velocity);
    const Reprojection r = reproject(terrain, p.x[i] + way.x(), p.y[i] + way.y(), p.z[i] + way.z());
    if (!r.on_ground.inside() || !terrain.known(r.on_ground)) {
      work.removed[i] = 1;
      return 0.0;
    }
    const Vec3 normal = terrain.normal(r.on_ground);
    const Vec3 u = along_ground(s.velocity, normal, added_speed);
    p.x[i] = r.x;
    p.y[i] = r.y;
    p.z[i] = terrain.height(r.on_ground);
    p.ux[i] = u.x();
    p.uy[i] = u.y();
    p.uz[i] = u.z();
    work.places[i] = r.on_ground;
    work.normals[i] = normal;
    return 0.5 * p.mass[i] * s.velocity.squaredNorm();
  };
  parallel_pieces(std::ptrdiff_t(p.size()), model.threads, particles_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    double sum = 0;
                    for (std::ptrdiff_t i = begin; i < end; ++i) sum += move(std::size_t(i));
                    work.piece_sums[std::size_t(begin / particles_in_piece)] = sum;
                  });
  // Piece by piece, so that the sum does not depend on the threads.
  const std::ptrdiff_t pieces =
      (std::ptrdiff_t(p.size()) + particles_in_piece - 1) / particles_in_piece;
  state.kinetic_energy =
      std::accumulate(work.piece_sums.begin(), work.piece_sums.begin() + pieces, 0.0);
  state.peak_kinetic = std::max(state.peak_kinetic, state.kinetic_energy);
  state.stopped = state.kinetic_energy <= model.settings.stop_ratio * state.peak_kinetic;
}

namespace {

/// Keeps the entries of an array whose particles stay.
template <class Array>
void keep(const std::vector<std::uint32_t>& new_place, Array& array) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < new_place.size(); ++i)
    if (new_place[i] != gone) array[kept++] = array[i];
  array.resize(kept);
}

template <class Array>
void reorder(const std::vector<std::uint32_t>& order, Array& array) {
  Array sorted(array.size());
  for (std::size_t e = 0; e < order.size(); ++e) sorted[e] = array[order[e]];
  array = std::move(sorted);
}

}  // namespace

void remove_marked(SlideState& state, SlideWork& work) {
  if (std::find(work.removed.begin(), work.removed.end(), 1) == work.removed.end()) return;
  SlideParticles& p = state.particles;
  std::vector<std::uint32_t>& new_place = work.new_places;
  new_place.resize(p.size());
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    new_place[i] = work.removed[i] ? gone : kept++;
    if (!work.removed[i]) continue;
    state.balance.left += p.mass[i];
    ++state.balance.particles_left;
  }
  p.for_each_array([&](const char*, auto& array) { keep(new_place, array); });
  keep(new_place, work.places);
  keep(new_place, work.normals);
  keep(new_place, work.thickness);
  renumber(state.bonds, new_place);
  work.bond_lists.update(state.bonds, p.size());
}

namespace {

/// Gives the particles from `begin` on, which have the ids of those they split from, ids of their
/// own, in the order of these: the order in which particles are stored must not tell.
void number_new(SlideState& state, SlideWork& work, std::size_t begin) {
  SlideParticles& p = state.particles;
  std::vector<std::uint32_t>& order = work.new_places;
  order.resize(p.size() - begin);
  std::iota(order.begin(), order.end(), std::uint32_t(begin));
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return p.id[a] < p.id[b]; });
  for (const std::uint32_t i : order) p.id[i] = state.next_id++;
}

}  // namespace

void split_heavy(const SlideModel& model, SlideState& state, SlideWork& work) {
  SlideParticles& p = state.particles;
  if (state.erodible.empty() && !model.compatible()) return;  // nothing makes them heavier
  const std::size_t before = p.size();
  for (std::size_t i = 0; i < before; ++i) {
    if (!(p.mass[i] > p.fresh_mass[i] * model.settings.split_ratio)) continue;
    const double area = p.mass[i] / (model.settings.density * std::max(work.thickness[i], 1e-6));
    const double distance = 0.41 * std::sqrt(area / 3.14159265358979323846);
    Vec3 along{p.ux[i], p.uy[i], p.uz[i]};
    const double speed = along.norm();
    along = speed > 0 ? Vec3(along * (distance / speed)) : Vec3(distance, 0, 0);
    const Vec3 x{p.x[i], p.y[i], p.z[i]};
    const GridPlace behind = model.terrain.place(x.x() - along.x(), x.y() - along.y());
    const GridPlace ahead = model.terrain.place(x.x() + along.x(), x.y() + along.y());
    if (!behind.inside() || !ahead.inside() || !model.terrain.known(behind) ||
        !model.terrain.known(ahead))
      continue;
    p.for_each_array([i](const char*, auto& array) { array.push_back(array[i]); });
    p.mass[i] = p.mass.back() = 0.5 * p.mass[i];
    const auto put = [&](std::size_t at, const Vec3& to, const GridPlace& place) {
      p.x[at] = to.x();
      p.y[at] = to.y();
      p.z[at] = model.compatible() ? to.z() : model.terrain.height(place);
      work.places[at] = place;
      work.normals[at] = model.terrain.normal(place);
    };
    work.places.push_back(ahead);
    work.normals.push_back(Vec3::Zero());
    work.thickness.push_back(work.thickness[i]);
    put(i, x - along, behind);
    put(p.size() - 1, x + along, ahead);
  }
  if (p.size() == before) return;
  number_new(state, work, before);
  work.bond_lists.update(state.bonds, p.size());
}

void sort_by_cell(SlideState& state, const std::vector<std::uint32_t>& order) {
  state.particles.for_each_array([&](const char*, auto& array) { reorder(order, array); });
  std::vector<std::uint32_t> new_place(order.size());
  for (std::size_t e = 0; e < order.size(); ++e) new_place[order[e]] = std::uint32_t(e);
  renumber(state.bonds, new_place);
}

}  // namespace snowshed
