#include "snowshed/methods/slide/surface_pressure.hpp"

#include <algorithm>
#include <cmath>

namespace snowshed {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double least_thickness = 1e-6;  // m

/// A particle as its neighbours see it.
struct Seen {
  double x, y, z;
  double weight;  // of its pressure: n_z times the factor for few neighbours
};

Seen seen(const SlideWork& work, std::size_t e) {
  return {work.cells.x()[e], work.cells.y()[e], work.entry_z[e], work.entry_weight[e]};
}

/// Calls f(entry, begin, end) for each particle and each of the three runs of entries in the cells
/// around it; all of a row of cells are called by one thread.
template <class F>
void for_each_run(const CellLists& cells, int row, F f) {
  for (int column = 1; column + 1 < cells.columns(); ++column)
    for (std::uint32_t e = cells.begin(column, row); e < cells.begin(column + 1, row); ++e)
      for (int k = row - 1; k <= row + 1; ++k)
        f(e, cells.begin(column - 1, k), cells.begin(column + 2, k));
}

/// The sum over a run of m_l (w_k + w_l) / 2 (R - r)^2 / r times the way to each neighbour.
Vec3 push_of(const SlideWork& work, const Seen& k, std::uint32_t begin, std::uint32_t end,
             double radius) {
  const double *px = work.cells.x(), *py = work.cells.y(), *mass = work.cells.mass();
  const double *pz = work.entry_z.data(), *weight = work.entry_weight.data();
  const double least = 1e-3 * radius;
  double sx = 0, sy = 0, sz = 0;
#pragma omp simd reduction(+ : sx, sy, sz)
  for (std::uint32_t e = begin; e < end; ++e) {
    const double dx = px[e] - k.x, dy = py[e] - k.y, dz = pz[e] - k.z;
    const double r = std::max(least, std::sqrt(dx * dx + dy * dy + dz * dz));
    const double inside = std::max(0.0, radius - r);
    const double w = mass[e] * 0.5 * (k.weight + weight[e]) * inside * inside / r;
    sx += w * dx;
    sy += w * dy;
    sz += w * dz;
  }
  return {sx, sy, sz};
}

/// By how much the kernel's sum over few neighbours falls short of the pressure of snow, inverted.
/// In a triangular lattice with N particles within the kernel the sum is 1 - 5 N^-1.4 of the
/// integral, within a few percent for N above 10.
double few_neighbours(double particles_in_kernel) {
  return 1 / std::max(0.5, 1 - 5 * std::pow(particles_in_kernel, -1.4));
}

/// The sum over a run of m_l (R - r)^3 around a particle.
double cover_of(const SlideParticles& p, const CellLists& cells, std::uint32_t i,
                std::uint32_t begin, std::uint32_t end, double radius) {
  double sum = 0;
  for (std::uint32_t e = begin; e < end; ++e) {
    const std::uint32_t l = cells.particle(e);
    const double distance = std::hypot(p.x[l] - p.x[i], p.y[l] - p.y[i], p.z[l] - p.z[i]);
    const double inside = std::max(0.0, radius - distance);
    sum += p.mass[l] * inside * inside * inside;
  }
  return sum;
}

}  // namespace

void add_surface_pressure(const SlideModel& model, const SlideState& state, SlideWork& work) {
  if (!work.entrained.empty())  // new masses
    work.cells.update(state.particles, work.places.column, work.places.row, model.threads);
  const CellLists& cells = work.cells;
  const double radius = model.terrain.cell();
  const double kernel_mass = pi * radius * radius * model.settings.density;  // kg per m of snow
  work.entry_z.resize(cells.size());
  work.entry_weight.resize(cells.size());
  parallel_pieces(std::ptrdiff_t(cells.size()), model.threads_for(cells.size()), particles_in_piece,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    for (std::ptrdiff_t e = begin; e < end; ++e) {
                      const std::uint32_t i = cells.particle(std::size_t(e));
                      work.entry_z[e] = state.particles.z[i];
                      const double h = std::max(work.thickness[i], least_thickness);
                      const double count = kernel_mass * h / state.particles.mass[i];
                      work.entry_weight[e] = work.places.nz[i] * few_neighbours(count);
                    }
                  });
  const double slope = -30 / (pi * std::pow(radius, 5));  // of the kernel
  const double factor = slope * model.gravity / model.settings.density;
  parallel_pieces(
      cells.rows() - 2, model.threads_for(cells.size()), 1, [&](std::ptrdiff_t j, std::ptrdiff_t) {
        for_each_run(cells, int(j) + 1,
                     [&](std::uint32_t e, std::uint32_t begin, std::uint32_t end) {
                       const std::uint32_t i = cells.particle(e);
                       const Vec3 push = factor * push_of(work, seen(work, e), begin, end, radius);
                       const Vec3 n = work.places.normal(i), along = push - push.dot(n) * n;
                       work.loads.ax[i] += along.x();
                       work.loads.ay[i] += along.y();
                       work.loads.az[i] += along.z();
                     });
      });
}

double pressure_energy(const SlideModel& model, const SlideState& state, const SlideWork& work) {
  const CellLists& cells = work.cells;
  const double radius = model.terrain.cell();
  const double kernel = 10 / (pi * std::pow(radius, 5));
  const double factor = 0.5 * kernel * model.gravity / model.settings.density;
  double sum = 0;
  for (int row = 1; row + 1 < cells.rows(); ++row)
    for_each_run(cells, row, [&](std::uint32_t e, std::uint32_t begin, std::uint32_t end) {
      const std::uint32_t i = cells.particle(e);
      sum += factor * state.particles.mass[i] * work.places.nz[i] *
             cover_of(state.particles, cells, i, begin, end, radius);
    });
  return sum;
}

}  // namespace snowshed
