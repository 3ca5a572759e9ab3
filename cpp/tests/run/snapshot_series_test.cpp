#include "snowshed/run/snapshot_series.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"

namespace snowshed::run {
namespace {

using SnapshotSeriesTest = io::TemporaryFolder;

std::unique_ptr<methods::Method> falling_snow() {
  auto solver = methods::mpm::make_solver(
      methods::mpm::options_for({2, methods::mpm::Precision::float32}), {});
  solver->add(methods::mpm::filled_box(2, Vec3::Zero(), Vec3(0.02, 0, 0.02), 0.005));
  return solver;
}

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

TEST_F(SnapshotSeriesTest, WritesOneSnapshotPerInterval) {
  const auto solver = falling_snow();
  SnapshotSeries series(path("snapshots"), 0.01, solver->time());
  while (solver->time() < 0.035) {
    if (series.due(solver->time())) series.write(*solver);
    solver->step();
  }
  for (const char* name : {"000000", "000001", "000002", "000003"})
    EXPECT_TRUE(
        std::filesystem::exists(path("snapshots") / ("snapshot_" + std::string(name) + ".vtp")))
        << name;
  const std::string index = content(path("snapshots") / "snapshots.pvd");
  EXPECT_EQ(occurrences(index, "<DataSet"), 4u);
}

TEST_F(SnapshotSeriesTest, AResumedSeriesRepeatsNoSnapshot) {
  const auto solver = falling_snow();
  {
    SnapshotSeries series(path("snapshots"), 0.01, 0.0);
    series.write(*solver);
    methods::mpm::run_until(*solver, 0.01);
    series.write(*solver);
  }
  SnapshotSeries series(path("snapshots"), 0.01, solver->time());
  EXPECT_FALSE(series.due(solver->time()));
  methods::mpm::run_until(*solver, 0.02);
  EXPECT_TRUE(series.due(solver->time()));
  series.write(*solver);
  EXPECT_TRUE(std::filesystem::exists(path("snapshots") / "snapshot_000002.vtp"));
  EXPECT_EQ(occurrences(content(path("snapshots") / "snapshots.pvd"), "<DataSet"), 3u);
}

TEST_F(SnapshotSeriesTest, FilesContainAllQuantities) {
  const auto solver = falling_snow();
  write_particles(path("snow.vtp"), *solver);
  const std::string file = content(path("snow.vtp"));
  EXPECT_NE(file.find("NumberOfPoints=\"16\""), std::string::npos);
  for (const char* name :
       {"velocity", "mass", "event", "density", "pressure", "volumetric_plastic_strain", "\"id\""})
    EXPECT_NE(file.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace snowshed::run
