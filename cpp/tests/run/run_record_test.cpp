#include "snowshed/run/run_record.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/descriptor.hpp"
#include "snowshed/methods/registry.hpp"

namespace snowshed::run {
namespace {

TEST(EventRecord, ResidualIsTheShareOfEnergyGainedOrLost) {
  EventRecord record;
  EXPECT_FALSE(record.energy_residual().has_value());  // without the energy balance
  record.energy = {{"kinetic_j", 2.0}, {"gravity_j", -8.0}, {"residual_j", -0.4}};
  EXPECT_DOUBLE_EQ(*record.energy_residual(), 0.05);
  EXPECT_GT(record.energy_residual(), max_energy_residual);
  record.energy = {{"kinetic_j", 0.0}, {"residual_j", 0.0}};
  EXPECT_EQ(*record.energy_residual(), 0.0);
}

TEST(EventRecord, TheLastEnergyOfEveryMethodIsItsResidual) {
  for (const methods::MethodDescriptor* method : methods::all_methods())
    if (!method->info().energies.empty())
      EXPECT_EQ(method->info().energies.back(), "residual_j") << method->info().name;
}

using RunRecordTest = io::TemporaryFolder;

TEST_F(RunRecordTest, EventsEndAtRestOrAtTheTimeLimit) {
  const auto ended = [&](const std::string& end) {
    std::ofstream(path("run.json")) << R"({"wall_s": 1, "finished_events": [{"event": 1,
        "sim_time_s": 1, "steps": 1, "wall_s": 1, "laid_height_m": 0, "ended": ")"
                                    << end << "\"}]}";
    return RunRecord::read(path("run.json"), {}).finished_events.at(0).ended;
  };
  EXPECT_EQ(ended("rest"), RunEnd::rest);
  EXPECT_EQ(ended("time_limit"), RunEnd::time_limit);
  EXPECT_THROW(ended("paused"), InputError);
}

}  // namespace
}  // namespace snowshed::run
