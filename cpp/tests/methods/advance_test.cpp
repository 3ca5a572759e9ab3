#include "snowshed/methods/advance.hpp"

#include <gtest/gtest.h>

#include "methods/block/solver.hpp"

namespace snowshed::methods {
namespace {

TEST(AdvanceTo, EndsWithTheStepThatReachesTheTime) {
  block::Settings settings;
  settings.time_step = 0.25;
  block::Solver solver({settings, 9.81});
  solver.add(solver.seed({}));
  advance_to(solver, 0.6);
  EXPECT_EQ(solver.time(), 0.75);
  advance_to(solver, 0.75);
  advance_to(solver, 0.1);
  EXPECT_EQ(solver.counters().steps, 3);
}

}  // namespace
}  // namespace snowshed::methods
