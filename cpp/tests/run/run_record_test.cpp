#include "snowshed/run/run_record.hpp"

#include <gtest/gtest.h>

namespace snowshed {
namespace {

TEST(EventFacts, TellWhatShareOfTheEnergyWasGainedOrLost) {
  EventFacts facts;
  EXPECT_FALSE(facts.energy_residual().has_value());  // without the energy balance
  facts.energy = {{"kinetic_j", 2.0}, {"gravity_j", -8.0}, {"residual_j", -0.4}};
  EXPECT_DOUBLE_EQ(*facts.energy_residual(), 0.05);
  EXPECT_GT(facts.energy_residual(), largest_energy_residual);
  facts.energy = {{"kinetic_j", 0.0}, {"residual_j", 0.0}};
  EXPECT_EQ(*facts.energy_residual(), 0.0);
}

}  // namespace
}  // namespace snowshed
