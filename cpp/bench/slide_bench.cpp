// Time of the snow slide's steps, per particle: a release on an inclined plane that runs out on
// level ground, with and without bonds, while it slides.
#include "slide_bench.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>

#include "snowshed/core/angles.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed {
namespace {

constexpr double cell = 2, thickness = 0.5;  // m
constexpr int steps_before = 150;            // 1.5 s: the slide moves, most bonds hold

geometry::HeightField plane_with_run_out(double width) {
  geometry::HeightField f;
  f.cell = cell;
  f.columns = int((width + 240) / cell);
  f.rows = int((width + 40) / cell);
  const double slope = std::tan(radians(35));
  for (int row = 0; row < f.rows; ++row)
    for (int column = 0; column < f.columns; ++column)
      f.heights.push_back(500 - slope * std::min(column * cell, width + 160));
  return f;
}

std::unique_ptr<methods::slide::Solver> sliding_snow(double particles, methods::slide::Mode mode,
                                                     bool bonds, int threads) {
  const double width = std::sqrt(particles / 2) * cell;  // two particles a cell
  methods::slide::Options o;
  o.terrain = plane_with_run_out(width);
  const double low = 20, high = 20 + width;
  o.areas.release = {
      {"slab", {{{low, low}, {high, low}, {high, high}, {low, high}}, {}}, thickness}};
  o.settings.mode = mode;
  o.settings.bonds = bonds;
  o.settings.threads = threads;
  o.settings.stop_ratio = 0;
  auto slide = methods::slide::make_solver(std::move(o));
  slide->add(slide->seed());
  for (int i = 0; i < steps_before; ++i) slide->step();
  return slide;
}

void add(const std::string& name, double particles, methods::slide::Mode mode, bool bonds,
         int threads) {
  const std::string full_name = "slide/" + name + "/" + std::to_string(int(particles));
  benchmark::RegisterBenchmark(full_name.c_str(),
                               [=](benchmark::State& state) {
                                 const auto slide = sliding_snow(particles, mode, bonds, threads);
                                 std::int64_t updates = 0;
                                 for (auto _ : state) {
                                   slide->step();
                                   updates += std::int64_t(slide->size());
                                 }
                                 state.SetItemsProcessed(updates);
                                 state.counters["bytes/particle"] =
                                     double(slide->bytes()) / double(slide->size());
                               })
      ->Arg(threads)
      ->UseRealTime();
}

}  // namespace

void add_slides() {
  for (const double particles : {360., 1100., 1e5, 1e6})
    for (const int threads : {1, 2}) {
      add("compatible", particles, methods::slide::Mode::compatible, true, threads);
      add("improved", particles, methods::slide::Mode::improved, true, threads);
      add("improved_without_bonds", particles, methods::slide::Mode::improved, false, threads);
    }
}

}  // namespace snowshed
