// The tables of forces of a run: rows, loads, files, and runs that are resumed.
#include "snowshed/run/force_history.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <sstream>

#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/file_bytes.hpp"
#include "snowshed/run/event_sequence.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

scene::Scene scene_with_forces() {
  scene::Scene scene = small_scene();
  scene.output.energy = false;
  scene.output.forces = true;
  return scene;
}

/// The values of a column for an obstacle in an event.
std::vector<double> values_of(const NumberTable& table, const std::string& column, double event,
                              double obstacle) {
  const auto index = [&](const std::string& name) {
    return std::size_t(std::find(table.columns.begin(), table.columns.end(), name) -
                       table.columns.begin());
  };
  std::vector<double> values;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const double* row = table.values.data() + r * table.columns.size();
    if (row[index("event")] == event && row[index("obstacle")] == obstacle)
      values.push_back(row[index(column)]);
  }
  return values;
}

TEST(ForceHistory, RowsAreMeansWhoseSumIsTheImpulseOfTheEvent) {
  const auto sim = run_all(scene_with_forces());
  const ForceHistory& history = *sim->force_history();
  EXPECT_EQ(history.names(), (std::vector<std::string>{"ground", "panel", "unbalanced"}));
  for (const double event : {1, 2, 3})
    for (const double obstacle : {0, 1}) {
      const auto force = values_of(history.forces(), "fz_n", event, obstacle);
      const auto duration = values_of(history.forces(), "duration_s", event, obstacle);
      const double impulse = std::inner_product(force.begin(), force.end(), duration.begin(), 0.0);
      const double expected = values_of(history.loads(), "impulse_z_ns", event, obstacle).at(0);
      EXPECT_NEAR(impulse, expected, 1e-9 * std::abs(expected));
      EXPECT_GT(force.size(), 5u);
    }
}

TEST(ForceHistory, StackAtRestHasItsWeight) {
  scene::Scene scene = scene_with_forces();
  scene.events.max_time = 3;
  scene.events.count = 1;
  const auto sim = run_all(scene);
  ASSERT_TRUE(sim->force_history()->ended_at_rest());
  double weight = 0;
  for (const double mass : sim->method().state().masses) weight += 9.81 * mass;
  double sum = 0;
  for (const double obstacle : {0, 1})
    sum += values_of(sim->force_history()->loads(), "rest_fz_n", 1, obstacle).at(0);
  EXPECT_NEAR(sum / -weight, 1, 1e-3);
  const double peak = values_of(sim->force_history()->loads(), "peak_10ms_n", 1, 0).at(0);
  EXPECT_GT(peak, weight);
  EXPECT_LE(peak, values_of(sim->force_history()->loads(), "peak_1ms_n", 1, 0).at(0) * 1.001);
}

class ForceFiles : public io::TemporaryFolder {};

TEST_F(ForceFiles, InterruptedRunsHaveTheSameTables) {
  const scene::Scene scene = scene_with_forces();
  const auto uninterrupted = run_all(scene),
             parts = with_interruptions(scene, 2, path("checkpoint"));
  EXPECT_TRUE(parts->force_history()->forces_csv() == uninterrupted->force_history()->forces_csv());
  EXPECT_TRUE(parts->force_history()->loads_csv() == uninterrupted->force_history()->loads_csv());
  EXPECT_EQ(parts->pressures().peak, uninterrupted->pressures().peak);
  EXPECT_EQ(parts->pressures().rest, uninterrupted->pressures().rest);
}

TEST_F(ForceFiles, AreInTheResultsFolder) {
  auto sequence = EventSequence::create(scene_with_forces(), ".", path("results"));
  EventObserver observer;
  ASSERT_TRUE(sequence.run(observer, 10));
  for (const char* name : {"forces.csv", "loads.csv", "pressures/event_003.vtp"})
    EXPECT_TRUE(std::filesystem::exists(path("results") / name)) << name;
  EXPECT_EQ(sequence.record().files.count("forces.csv"), 1u);
  std::istringstream lines(io::read_bytes(path("results") / "loads.csv"));
  std::string head, first;
  std::getline(lines, head);
  std::getline(lines, first);
  EXPECT_EQ(head.rfind("event,obstacle,at_rest,rest_fx_n,rest_fy_n,rest_fz_n", 0), 0u) << head;
  EXPECT_EQ(first.rfind("1,ground,", 0), 0u) << first;
}

TEST(ForceHistory, MethodsWithoutObstaclesRefuseIt) {
  EXPECT_THROW(scene::parse_scene(R"({"snowshed": 2, "method": "grains",
      "sample": {"file": "a.npy"}, "output": {"forces": true}})"),
               InputError);
}

}  // namespace
}  // namespace snowshed::run
