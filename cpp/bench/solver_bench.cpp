// Benchmarks of complete steps of the solver, in particle updates per second:
//
// - the slab of snow on which other MPM codes were measured (2 x 0.5 x 1 m, dx 1/32 m, 8 particles
//   per cell), and a two-dimensional slab;
// - the bare kernel on the same slab;
// - the same slab with single features added or removed;
// - the cost against the number of particles;
// - the matrix of all kernels, on small slabs that flow.
//
// Sleep is off, except in the benchmarks of sleep.
#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <string>

#include "bare_kernel.hpp"
#include "slide_bench.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/methods/mpm/solver.hpp"

namespace snowshed {
namespace {

constexpr double slab_dx = 1.0 / 32;
constexpr int slab_cells[3] = {64, 16, 32};

/// Returns a lattice of two particles per cell in each direction. It is 2D if cells[1] is 0.
methods::ParticleBatch slab(const int (&cells)[3], double dx, double density) {
  const double h = dx / 2;
  const bool flat = cells[1] == 0;
  methods::ParticleBatch batch;
  for (int i = 0; i < 2 * cells[0]; ++i)
    for (int j = 0; j < (flat ? 1 : 2 * cells[1]); ++j)
      for (int k = 0; k < 2 * cells[2]; ++k)
        batch.positions.push_back(Vec3(i + 0.5, flat ? 0.0 : j + 0.5, k + 0.5) * h);
  batch.mass = density * h * h * (flat ? 1.0 : h);
  return batch;
}

/// A benchmark case.
struct Case {
  methods::mpm::Options options;
  methods::ParticleBatch batch;
  int steps_before = 10;
};

Case slab_3d(const Vec3& velocity = Vec3::Zero()) {
  Case c;
  c.options.settings.dx = slab_dx;
  c.options.settings.sleep_speed = 0;
  c.batch = slab(slab_cells, slab_dx, c.options.snows[0].density);
  c.batch.velocity = velocity;
  c.options.obstacles = {{"ground",
                          geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()),
                          {methods::Condition::sticky, 0.0},
                          {}}};
  return c;
}

Case slab_2d() {
  Case c;
  c.options.dimension = 2;
  c.options.settings.sleep_speed = 0;
  c.batch = slab({200, 0, 25}, c.options.settings.dx, c.options.snows[0].density);
  c.options.obstacles = {{"ground",
                          geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()),
                          {methods::Condition::sticky, 0.0},
                          {}}};
  return c;
}

void report(benchmark::State& state, std::size_t particles, double bytes) {
  state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(particles));
  state.counters["bytes/particle"] = bytes / double(particles);
}

void run(benchmark::State& state, const Case& c, int threads) {
  methods::mpm::Options options = c.options;
  options.settings.threads = threads;
  const auto solver = methods::mpm::make_solver(options);
  solver->add(c.batch);
  for (int i = 0; i < c.steps_before; ++i) solver->step();
  for (auto _ : state) solver->step();
  report(state, solver->size(), double(solver->bytes()));
}

void add(const std::string& name, const std::function<Case()>& make, std::vector<int> threads) {
  for (int n : threads)
    benchmark::RegisterBenchmark((name + "/" + std::to_string(n)).c_str(),
                                 [make, n](benchmark::State& state) { run(state, make(), n); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

void add(const std::string& name, Case c, const std::function<void(Case&)>& change,
         std::vector<int> threads) {
  add(
      name,
      [c, change] {
        Case changed = c;
        change(changed);
        return changed;
      },
      std::move(threads));
}

// --- the slab ---------------------------------------------------------------------------------

const Vec3 impact_velocity(5, 0, -5);  // onto the ground

/// Returns a case in which the slab flows: after `steps_before` steps, nine of ten SIMD packs yield
/// in each step.
Case slab_in_flow() {
  Case c = slab_3d(impact_velocity);
  c.steps_before = 160;
  return c;
}

void add_slabs() {
  const auto unchanged = [](Case&) {};
  const auto in_double = [](Case& c) {
    c.options.settings.precision = methods::mpm::Precision::float64;
  };
  add("slab_3d/float_at_rest", slab_3d(), unchanged, {1, 2});
  add("slab_3d/float_in_plastic_flow", slab_in_flow(), unchanged, {1, 2});
  add("slab_3d/double_at_rest", slab_3d(), in_double, {1, 2});
  add("slab_2d/float_at_rest", slab_2d(), unchanged, {1, 2});
  add("slab_2d/double_at_rest", slab_2d(), in_double, {1, 2});
  for (int threads : {1, 2})
    benchmark::RegisterBenchmark(("bare_kernel_3d/float/" + std::to_string(threads)).c_str(),
                                 [threads](benchmark::State& state) {
                                   BareKernel kernel(slab_cells, threads);
                                   for (auto _ : state) kernel.step();
                                   if (std::abs(kernel.grid_mass() / kernel.mass() - 1) > 1e-4)
                                     state.SkipWithError("the bare kernel lost mass");
                                   report(state, kernel.size(), 0);
                                 })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

// --- the cost of each feature -----------------------------------------------------------------

/// Returns the base case, elastic snow in free fall: only the transfers and a stress.
Case free_fall() {
  Case c = slab_3d(Vec3(0, 0, -1));
  c.options.snows[0].model = material::SnowModel::elastic;
  c.options.obstacles.clear();
  return c;
}

Case slab_on_ground(methods::Condition condition, bool moving = false) {
  Case c = free_fall();
  methods::Obstacle ground{
      "ground", geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), {condition, 0.3}, {}};
  if (moving) {
    geometry::MotionSpec motion;
    motion.velocity = Vec3(0, 0, -0.1);
    ground.motion.emplace(motion);
  }
  c.options.obstacles = {ground};
  return c;
}

void add_prices() {
  using C = Case;
  const auto price = [](const std::string& feature, Case c, const std::function<void(C&)>& change) {
    add("price/" + feature, std::move(c), change, {1});
  };
  const auto unchanged = [](C&) {};
  price("base_3d", free_fall(), unchanged);
  price("base_2d", free_fall(), [](C& c) {
    c.options.dimension = 2;
    c.batch = slab({256, 0, 256}, slab_dx, c.options.snows[0].density);
  });
  price("cam_clay_elastic", free_fall(),
        [](C& c) { c.options.snows[0].model = material::SnowModel::cam_clay; });
  price("ground_cam_clay_in_flow", slab_in_flow(), unchanged);
  price("ground_elastic_in_flow", slab_in_flow(),
        [](C& c) { c.options.snows[0].model = material::SnowModel::elastic; });
  price("double", free_fall(),
        [](C& c) { c.options.settings.precision = methods::mpm::Precision::float64; });
  price("cubic", free_fall(), [](C& c) { c.options.settings.basis = methods::mpm::Basis::cubic; });
  price("apic", free_fall(),
        [](C& c) { c.options.settings.transfer = methods::mpm::Transfer::apic; });
  price("sticky_contact", slab_on_ground(methods::Condition::sticky), unchanged);
  price("slip_contact", slab_on_ground(methods::Condition::slip), unchanged);
  price("separate_contact", slab_on_ground(methods::Condition::separate), unchanged);
  price("moving_contact", slab_on_ground(methods::Condition::sticky, true), unchanged);
  price("several_snows", free_fall(), [](C& c) { c.options.snows.assign(2, material::Snow()); });
  price("energy_balance", free_fall(), [](C& c) {
    c.options.snows.assign(2, material::Snow());
    c.options.energy = true;
  });
  price("sleep_of_awake_snow", free_fall(), [](C& c) { c.options.settings.sleep_speed = 0.02; });
  // Without gravity the slab is at rest from the start.
  price("sleep_at_rest", slab_3d(), [](C& c) {
    c.options.settings.sleep_speed = 0.02;
    c.options.gravity = 0;
    c.steps_before = 1000;
  });
}

// --- cost against the number of particles -----------------------------------------------------

void add_scaling() {
  for (const double particles : {1e4, 1e5, 1e6, 1e7}) {
    const int edge = int(std::lround(std::cbrt(particles / 8 / 4)));
    add("scaling_3d/" + std::to_string(int(particles)),
        [edge] {
          Case c = slab_3d();
          c.batch = slab({2 * edge, 2 * edge, edge}, slab_dx, c.options.snows[0].density);
          return c;
        },
        {2});
  }
}

// --- every kernel ------------------------------------------------------------------------------

/// The snow for one kind of kernels, see KernelChoice.
struct MatrixSnow {
  const char* name;
  std::function<void(methods::mpm::Options&)> choose;
};

const std::vector<MatrixSnow>& matrix_snows() {
  static const std::vector<MatrixSnow> snows = {
      {"elastic",
       [](methods::mpm::Options& o) { o.snows[0].model = material::SnowModel::elastic; }},
      {"cam_clay", [](methods::mpm::Options&) {}},
      {"several", [](methods::mpm::Options& o) { o.snows.assign(2, material::Snow()); }},
      {"energy", [](methods::mpm::Options& o) {
         o.snows.assign(2, material::Snow());
         o.energy = true;
       }}};
  return snows;
}

Case matrix_slab(int dimension) {
  Case c = dimension == 3 ? slab_3d(impact_velocity) : slab_2d();
  const double density = c.options.snows[0].density;
  if (dimension == 3) c.batch = slab({32, 16, 16}, slab_dx, density);
  c.batch.velocity = impact_velocity;
  return c;
}

void add_matrix() {
  for (const int dimension : {2, 3})
    for (const bool in_double : {false, true})
      for (const methods::mpm::Transfer transfer :
           {methods::mpm::Transfer::flip, methods::mpm::Transfer::apic})
        for (const methods::mpm::Basis basis :
             {methods::mpm::Basis::quadratic, methods::mpm::Basis::cubic})
          for (const MatrixSnow& snow : matrix_snows()) {
            const std::string name =
                std::string("matrix/") + (dimension == 3 ? "3d/" : "2d/") +
                (in_double ? "double/" : "float/") +
                (transfer == methods::mpm::Transfer::flip ? "flip/" : "apic/") +
                (basis == methods::mpm::Basis::quadratic ? "quadratic/" : "cubic/") + snow.name;
            add(name,
                [=] {
                  Case c = matrix_slab(dimension);
                  c.options.settings.precision = in_double ? methods::mpm::Precision::float64
                                                           : methods::mpm::Precision::float32;
                  c.options.settings.transfer = transfer;
                  c.options.settings.basis = basis;
                  snow.choose(c.options);
                  return c;
                },
                {1});
          }
}

#ifdef __clang__
const char* const compiler = "Clang " __clang_version__;
#else
const char* const compiler = "GCC " __VERSION__;
#endif

}  // namespace
}  // namespace snowshed

int main(int argc, char** argv) {
  snowshed::add_slabs();
  snowshed::add_prices();
  snowshed::add_scaling();
  snowshed::add_slides();
  snowshed::add_matrix();
  benchmark::AddCustomContext("compiler", snowshed::compiler);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
