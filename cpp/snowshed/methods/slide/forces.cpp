#include "snowshed/methods/slide/forces.hpp"

#include <algorithm>
#include <cmath>

namespace snowshed {
namespace {

constexpr double least_thickness = 1e-6;  // m
constexpr double least_speed = 1e-6;      // m/s

template <class F>
void for_each_piece_of(std::size_t n, int threads, F f) {
  parallel_pieces(std::ptrdiff_t(n), threads, particles_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t i = begin; i < end; ++i) f(std::size_t(i));
                  });
}

template <class F>
void for_each_particle(const SlideParticles& p, int threads, F f) {
  for_each_piece_of(p.size(), threads, f);
}

Vec3 velocity_of(const SlideParticles& p, std::size_t i) { return {p.ux[i], p.uy[i], p.uz[i]}; }

/// Draws a velocity toward that of the snow around, implicitly (artificial viscosity of SamosAT).
Vec3 mixed(const SlideModel& model, const Vec3& u, const Vec3& around, const Vec3& normal,
           double mass, double thickness, double dt) {
  const SlideSettings& s = model.settings;
  const Vec3 v = around - around.dot(normal) * normal;
  const double side = 2 * std::sqrt(mass * thickness / s.density);
  const double f = s.artificial_viscosity * 0.5 * s.density * (v - u).norm() * side * dt / mass;
  return (u + f * v) / (1 + f);
}

/// The ground's normal where a particle would be without forces at the end of the step.
Vec3 normal_ahead(const Terrain& terrain, const Vec3& ahead, const Vec3& here) {
  const Reprojection r = reproject(terrain, ahead.x(), ahead.y(), ahead.z());
  if (!r.on_ground.inside() || !terrain.known(r.on_ground)) return here;
  return terrain.normal(r.on_ground);
}

/// The node nearest to a place.
std::size_t nearest_node(const Terrain& terrain, const GridPlace& p) {
  return terrain.index(p.column + int(p.east >= 0.5), p.row + int(p.north >= 0.5));
}

/// Snow that a particle takes up; returns its mass (kg) and slows the particle down.
double entrain(const SlideModel& model, double erodible, double stress, double area, double dt,
               double speed, double& mass, Vec3& u) {
  const SlideSettings& s = model.settings;
  double taken, worked;  // kg, m2
  if (s.erosion_energy > 0) {
    taken = area * stress * speed * dt / s.erosion_energy;
    worked = area;
  } else {
    taken = erodible * std::sqrt(area) * speed * dt;
    worked = erodible / s.entrained_density;
  }
  if (!model.compatible()) taken = std::min(taken, erodible * area);  // no more than there is
  const double energy = worked * s.entrainment_shear + taken * s.entrainment_work;
  u *= mass / (mass + taken);
  mass += taken;
  if (energy > 0) u *= std::max(0.0, 1 - energy / (0.5 * mass * (speed * speed + least_speed)));
  return taken;
}

}  // namespace

void apply_ground(const SlideModel& model, SlideState& state, SlideWork& work) {
  SlideParticles& p = state.particles;
  const SlideSettings& s = model.settings;
  const Terrain& terrain = model.terrain;
  const double dt = state.step;
  for_each_particle(p, model.threads, [&](std::size_t i) {
    const GridPlace& place = work.places[i];
    const Vec3 here = work.normals[i];
    const double h = std::max(work.thickness[i], least_thickness);
    Vec3 u = mixed(model, velocity_of(p, i), work.fields.velocity(place), here, p.mass[i], h, dt);

    const Vec3 x{p.x[i], p.y[i], p.z[i]};
    const Vec3 end = normal_ahead(terrain, x + dt * u, here);
    const Vec3 mean = (here + end).normalized();
    const double curvature = u.dot(end - here) / dt;
    const double along_normal = -model.gravity * mean.z();
    const double pressing = std::max(0.0, -(along_normal + curvature));  // m/s2
    const double speed = u.norm();

    SlideLoad& load = work.loads[i];
    load.acceleration = -along_normal * mean;
    load.acceleration.z() -= model.gravity;
    load.force = Vec3::Zero();
    load.speed = speed;
    // Snow that leaves the ground is not held back by it.
    load.yield = model.friction.friction * pressing;
    load.drag = pressing > 0 ? model.friction.drag / (s.density * h) : 0.0;
    const std::size_t node = nearest_node(terrain, place);
    if (!work.entrained.empty()) work.entrained[i] = 0;
    if (!state.erodible.empty() && state.erodible[node] > 0) {
      const double stress = model.friction.stress(pressing * s.density * h, speed);
      work.entrained[i] = entrain(model, state.erodible[node], pressing > 0 ? stress : 0.0,
                                  p.mass[i] / (h * s.density), dt, speed, p.mass[i], u);
    }
    if (!model.resistance.empty()) load.drag += model.resistance[node] / h;
    if (model.compatible() && !work.entrained.empty()) {  // forces on the mass before, there
      const double share = 1 - work.entrained[i] / p.mass[i];
      load.acceleration *= share;
      load.yield *= share;
      load.drag *= share;
    }
    p.ux[i] = u.x();
    p.uy[i] = u.y();
    p.uz[i] = u.z();
    work.predicted[i] = {x.x() + dt * u.x(), x.y() + dt * u.y(), x.z() + dt * u.z(),
                         work.thickness[i]};
  });
  for (std::size_t i = 0; i < work.entrained.size(); ++i) {
    if (work.entrained[i] == 0) continue;
    const std::size_t node = nearest_node(terrain, work.places[i]);
    double& left = state.erodible[node];
    left = std::max(0.0, left - work.entrained[i] / terrain.nodes()[node].area);
    state.balance.entrained += work.entrained[i];
  }
}

namespace {

/// The sum over a run of neighbours of mass times the gradient of the spiky kernel.
struct Gradient {
  double x = 0, y = 0;
};
void add_run(const CellLists& cells, std::uint32_t begin, std::uint32_t end, double x, double y,
             double radius, Gradient& g) {
  const double* px = cells.x();
  const double* py = cells.y();
  const double* mass = cells.mass();
  const double least = 1e-3 * radius;
  double gx = 0, gy = 0;
#pragma omp simd reduction(+ : gx, gy)
  for (std::uint32_t e = begin; e < end; ++e) {
    const double dx = px[e] - x, dy = py[e] - y;
    const double r = std::max(least, std::sqrt(dx * dx + dy * dy));
    const double inside = std::max(0.0, radius - r);
    const double w = mass[e] * inside * inside / r;
    gx += w * dx;
    gy += w * dy;
  }
  g.x += gx;
  g.y += gy;
}

}  // namespace

void add_pressure(const SlideModel& model, const SlideState& state, SlideWork& work) {
  const SlideParticles& p = state.particles;
  if (!work.entrained.empty()) work.cells.update(p, work.places, model.threads);  // new masses
  const double radius = model.terrain.cell();
  const double pi = 3.14159265358979323846;
  const double slope = -30 / (pi * std::pow(radius, 5));  // of the kernel
  const double factor = slope * model.gravity / model.settings.density;
  const CellLists& cells = work.cells;
  parallel_pieces(cells.rows() - 2, model.threads, 1, [&](std::ptrdiff_t j, std::ptrdiff_t) {
    const int row = int(j) + 1;
    for (int column = 1; column + 1 < cells.columns(); ++column)
      for (std::uint32_t e = cells.begin(column, row); e < cells.begin(column + 1, row); ++e) {
        const double x = cells.x()[e], y = cells.y()[e];
        Gradient g;
        for (int neighbour = row - 1; neighbour <= row + 1; ++neighbour)
          add_run(cells, cells.begin(column - 1, neighbour), cells.begin(column + 2, neighbour), x,
                  y, radius, g);
        const std::uint32_t i = cells.particle(e);
        work.loads[i].force += factor * p.mass[i] * Vec3(g.x, g.y, 0.0);
      }
  });
}

void add_bonds(const SlideModel& model, SlideState& state, SlideWork& work) {
  Bonds& bonds = state.bonds;
  if (bonds.size() == 0) return;
  const SlideSettings& s = model.settings;
  const double stiffness = s.bond_modulus / std::sqrt(3.0);  // contact area h L / sqrt 3
  for_each_piece_of(bonds.size(), model.threads, [&](std::size_t b) {
    const PredictedPoint& k = work.predicted[bonds.first[b]];
    const PredictedPoint& l = work.predicted[bonds.second[b]];
    const Vec3 d{l.x - k.x, l.y - k.y, l.z - k.z};
    const double length = d.norm();
    const double strain = length / bonds.rest_length[b] - 1;
    const bool acts = length > s.min_bond_length;
    work.broken[b] = acts && std::abs(strain) > s.max_strain;
    const bool holds = acts && !work.broken[b];
    work.bond_forces[b] =
        (holds ? strain * 0.5 * (k.thickness + l.thickness) * stiffness : 0.0) * d;
  });
  for_each_particle(state.particles, model.threads, [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for (std::uint32_t e = work.bond_lists.begin(i); e < work.bond_lists.begin(i + 1); ++e) {
      const Vec3& force = work.bond_forces[work.bond_lists.bond(e)];
      sum += work.bond_lists.is_second(e) ? Vec3(-force) : force;
    }
    work.loads[i].force += sum;
  });
  const auto end = work.broken.begin() + std::ptrdiff_t(bonds.size());
  if (std::find(work.broken.begin(), end, 1) == end) return;
  remove_bonds(bonds, work.broken);
  work.bond_lists.update(bonds, state.particles.size());
}

}  // namespace snowshed
