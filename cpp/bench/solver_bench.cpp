// Whole steps of the solver: particle updates per second on the slab of snow that other MPM codes
// were measured on (2 x 0.5 x 1 m, dx 1/32 m, 8 particles per cell), and its two-dimensional kin.
#include <benchmark/benchmark.h>

#include "snowshed/geometry/primitives.hpp"
#include "snowshed/mpm/solver.hpp"

namespace snowshed {
namespace {

/// A lattice of cells x 2 particles along each direction, resting on sticky ground.
ParticleBatch slab(int nx, int ny, int nz, double dx, double density) {
  const double h = dx / 2;
  ParticleBatch batch;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < std::max(ny, 1); ++j)
      for (int k = 0; k < nz; ++k)
        batch.positions.push_back(Vec3(i + 0.5, ny ? j + 0.5 : 0.0, k + 0.5) * h);
  batch.mass = density * h * h * (ny ? h : 1.0);
  return batch;
}

void run(benchmark::State& state, SolverOptions options, const ParticleBatch& batch) {
  options.numerics.threads = int(state.range(0));
  const auto ground = make_plane(Vec3::Zero(), Vec3::UnitZ());
  const auto solver =
      make_solver(options, {{"ground", ground, {Condition::sticky, 0.0}, std::nullopt}});
  solver->add(batch);
  for (int i = 0; i < 10; ++i) solver->step();
  for (auto _ : state) solver->step();
  state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(solver->size()));
  state.counters["bytes/particle"] = double(solver->bytes()) / double(solver->size());
}

void slab_3d(benchmark::State& state, Precision precision, const Vec3& velocity) {
  SolverOptions options;
  options.numerics.dx = 1.0 / 32;
  options.numerics.precision = precision;
  ParticleBatch batch = slab(128, 32, 64, options.numerics.dx, options.snow.density);
  batch.velocity = velocity;
  run(state, options, batch);
}

void slab_2d(benchmark::State& state, Precision precision) {
  SolverOptions options;
  options.dimension = 2;
  options.numerics.precision = precision;
  run(state, options, slab(400, 0, 50, options.numerics.dx, options.snow.density));
}

BENCHMARK_CAPTURE(slab_3d, float_at_rest, Precision::float32, Vec3::Zero())
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(slab_3d, float_in_plastic_flow, Precision::float32, Vec3(5, 0, -5))
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(slab_3d, double_at_rest, Precision::float64, Vec3::Zero())
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(slab_2d, float_at_rest, Precision::float32)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(slab_2d, double_at_rest, Precision::float64)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace snowshed

BENCHMARK_MAIN();
