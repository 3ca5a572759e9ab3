// Snow of different events, each with its own velocity field.
#include "snowshed/methods/mpm/event_contacts.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "methods/mpm/solver_testing.hpp"
#include "snowshed/methods/mpm/model.hpp"

namespace snowshed::methods::mpm {
namespace {

Options event_options(const SolverVariant& variant, double dx = 0.01) {
  Options o = options_for(variant, dx);
  o.settings.adopt(Scheme::objective);
  o.settings.fields = Fields::events;
  return o;
}

Obstacle ground() {
  return fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::sticky);
}

ParticleBatch slab(int dimension, int event, const Vec3& low, const Vec3& high, double spacing) {
  ParticleBatch batch = filled_box(dimension, low, high, spacing);
  Random random(static_cast<std::uint64_t>(event));
  for (Vec3& x : batch.positions) x += random_vector(random, dimension, 0.35 * spacing);
  batch.event = event;
  return batch;
}

double top_of(const ParticleState& s) {
  double z = -1e9;
  for (const Vec3& x : s.positions) z = std::max(z, x.z());
  return z;
}

Vec3 momentum_of(const ParticleState& s, int event) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < s.positions.size(); ++i)
    if (s.events[i] == event) sum += s.masses[i] * s.velocities[i];
  return sum;
}

/// Height of the centre of mass of an event's snow, m.
double height_of(const ParticleState& s, int event) {
  double mass = 0, sum = 0;
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    if (s.events[i] != event) continue;
    mass += s.masses[i];
    sum += s.masses[i] * s.positions[i].z();
  }
  return sum / mass;
}

/// Mean distance (m) between adjacent slabs in a stack of slabs, 2 cm thick, that fall one after
/// the other.
double distance_of_slabs(const SolverVariant& variant, double dx, Fields fields, int slabs) {
  Options o = event_options(variant, dx);
  o.settings.scheme = Scheme::thesis;
  o.settings.fields = fields;
  const auto solver = make_solver(o, {ground()});
  const double spacing = dx / std::sqrt(6.0);
  double top = 0;
  for (int event = 1; event <= slabs; ++event) {
    solver->add(slab(variant.dimension, event, Vec3(-0.05, 0, top + 0.01),
                     Vec3(0.05, 0.03, top + 0.03), spacing));
    run_until(*solver, solver->time() + 0.12);
    top = top_of(solver->state());
  }
  const ParticleState s = solver->state();
  return (height_of(s, slabs) - height_of(s, 1)) / (slabs - 1);
}

class SlabsOnGrid : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(EventContacts, SlabsOnGrid, testing::Values(0.01, 0.005));

TEST_P(SlabsOnGrid, RestOnEachOther) {
  const double dx = GetParam();
  const double height = distance_of_slabs({2, Precision::float32}, dx, Fields::events, 5);
  EXPECT_NEAR(height, 0.02, 0.03 * 0.02);
  EXPECT_LT(height - 0.02, 0.11 * dx);
}

TEST(EventContacts, SlabsInOneFieldRestTwoCellsApart) {
  EXPECT_GT(distance_of_slabs({2, Precision::float32}, 0.01, Fields::one, 3), 0.027);
}

TEST(EventContacts, SlabsRestOnEachOtherInThreeDimensions) {
  EXPECT_NEAR(distance_of_slabs({3, Precision::float32}, 0.01, Fields::events, 2), 0.02,
              0.06 * 0.02);
}

std::unique_ptr<Solver> weightless_solver(Fields fields = Fields::events) {
  Options o = event_options({2, Precision::float64});
  o.settings.scheme = Scheme::thesis;
  o.settings.fields = fields;
  o.gravity = 0;
  return make_solver(o, {});
}

ParticleBatch lower_block(int event) {
  return slab(2, event, Vec3(0, 0, 0), Vec3(0.06, 0, 0.03), 0.004);
}

/// A block that touches the lower one and moves away from it.
ParticleBatch upper_block(int event) {
  ParticleBatch block = slab(2, event, Vec3(0, 0, 0.03), Vec3(0.06, 0, 0.06), 0.004);
  block.velocity.z() = 0.2;
  return block;
}

/// Returns the speed (m/s) that the upper block has given to the lower one, the snow of `event`.
double speed_carried_along(Solver& solver, int event) {
  run_until(solver, solver.time() + 0.02);
  return momentum_of(solver.state(), event).z() / (0.06 * 0.03 * 210);
}

TEST(EventContacts, SnowOfDifferentEventsDoesNotStick) {
  const auto speed_of_lower = [](Fields fields) {
    const auto solver = weightless_solver(fields);
    solver->add(lower_block(1));
    solver->add(upper_block(2));
    return speed_carried_along(*solver, 1);
  };
  EXPECT_NEAR(speed_of_lower(Fields::events), 0, 0.002);
  EXPECT_GT(speed_of_lower(Fields::one), 0.02);
}

/// With ten events, the first three share a field.
TEST(EventContacts, TheNewestEventSharesNoField) {
  for (const int lower : {3, 9}) {
    const auto solver = weightless_solver();
    for (int event = 1; event <= 9; ++event) {
      const double x = 0.3 * event;
      solver->add(event == lower ? lower_block(event)
                                 : slab(2, event, Vec3(x, 0, 0), Vec3(x + 0.01, 0, 0.01), 0.005));
    }
    solver->add(upper_block(10));
    EXPECT_NEAR(speed_carried_along(*solver, lower), 0, 0.002) << lower;
  }
}

TEST(EventContacts, SettlingKeepsTheFields) {
  const auto solver = weightless_solver();
  solver->add(lower_block(1));
  solver->add(upper_block(2));
  solver->settle(std::vector<double>(solver->size(), 0.0),
                 std::vector<double>(solver->size(), 0.0));
  EXPECT_NEAR(speed_carried_along(*solver, 1), 0, 0.002);
}

TEST(EventContacts, FrictionFollowsTheWeakestSnow) {
  Options o = event_options({2, Precision::float64});
  o.settings.event_friction = 0.5;
  o.snows = {material::Snow{}, material::Snow{}, material::Snow{}};
  o.snows[0].critical_state_slope = 1.2;
  o.snows[1].critical_state_slope = 0.6;
  const Model<double, 2> model(o);
  EXPECT_DOUBLE_EQ(model.event_friction(), 0.5 * 0.5 / std::sqrt(3.0));
}

/// Snow that falls on a layer comes to rest on it, whether the layer sleeps or not.
TEST(EventContacts, SleepingSnowCarriesSnowOfAnotherEvent) {
  const auto height_of_block = [](double sleep_speed) {
    Options o = event_options({2, Precision::float32});
    o.settings.sleep_speed = sleep_speed;
    const auto solver = make_solver(o, {ground()});
    solver->add(slab(2, 1, Vec3(-0.01, 0, 0), Vec3(0.04, 0, 0.02), 0.004));
    run_until(*solver, 0.15);
    EXPECT_EQ(solver->slept_updates() > 0, sleep_speed > 0);
    ParticleBatch block = slab(2, 2, Vec3(0, 0, 0.025), Vec3(0.03, 0, 0.045), 0.004);
    block.velocity.z() = -0.5;
    solver->add(block);
    run_until(*solver, 0.2);
    return height_of(solver->state(), 2);
  };
  EXPECT_NEAR(height_of_block(0.02), height_of_block(0), 0.0003);
}

/// Returns the coefficient of friction between a layer of snow and a block that starts at 1 m/s:
/// the momentum that the block loses, divided by the impulse that presses it onto the layer.
double friction_coefficient(int dimension, double dx, double event_friction, int seed) {
  Options o = event_options({dimension, Precision::float32}, dx);
  o.settings.event_friction = event_friction;
  const auto solver = make_solver(o, {ground()});
  const double spacing = dx / std::sqrt(6.0);
  solver->add(slab(dimension, 1, Vec3(-0.04, 0, 0), Vec3(0.2, 0.03, 0.03), spacing));
  run_until(*solver, 0.05);
  const double top = top_of(solver->state()) + spacing / 2;
  ParticleBatch block =
      slab(dimension, seed, Vec3(0, 0, top), Vec3(0.06, 0.03, top + 0.02), spacing);
  block.event = 2;
  block.velocity.x() = 1;
  solver->add(block);
  run_until(*solver, solver->time() + 0.02);
  const Vec3 before = momentum_of(solver->state(), 2);
  const double begin = solver->time();
  run_until(*solver, begin + 0.08);
  const Vec3 change = momentum_of(solver->state(), 2) - before;
  return -change.x() / (change.z() + block.total_mass() * 9.81 * (solver->time() - begin));
}

double mean_friction_coefficient(int dimension, double dx, double event_friction, int seeds) {
  double sum = 0;
  for (int seed = 2; seed < 2 + seeds; ++seed)
    sum += friction_coefficient(dimension, dx, event_friction, seed);
  return sum / seeds;
}

struct FrictionOnGrid {
  double dx, event_friction;
  int seeds;
};

void PrintTo(const FrictionOnGrid& c, std::ostream* out) {
  *out << c.dx << " m, friction " << c.event_friction;
}

class BlockOnSnow : public testing::TestWithParam<FrictionOnGrid> {};
INSTANTIATE_TEST_SUITE_P(EventContacts, BlockOnSnow,
                         testing::Values(FrictionOnGrid{0.01, 1, 8}, FrictionOnGrid{0.01, 0, 8},
                                         FrictionOnGrid{0.01, 2, 8}, FrictionOnGrid{0.005, 1, 4},
                                         FrictionOnGrid{0.005, 0, 4}, FrictionOnGrid{0.005, 2, 4}));

TEST_P(BlockOnSnow, FeelsTheGivenFriction) {
  const FrictionOnGrid c = GetParam();
  const double coefficient = 0.5 / std::sqrt(3.0);
  const double measured_coefficient = mean_friction_coefficient(2, c.dx, c.event_friction, c.seeds);
  if (c.event_friction == 0)
    EXPECT_LT(measured_coefficient, 0.02);  // the block ploughs a little
  else
    EXPECT_NEAR(measured_coefficient, c.event_friction * coefficient,
                (c.event_friction == 1 ? 0.07 : 0.3) * coefficient);
}

/// A block stops within the time that its friction implies, although some of its nodes stop
/// earlier.
TEST(EventContacts, ABlockStopsWithinTheTimeOfItsFriction) {
  double remaining_speed = 0;
  for (int seed = 2; seed < 10; ++seed) {
    const auto solver = make_solver(event_options({2, Precision::float32}), {ground()});
    solver->add(slab(2, 1, Vec3(-0.02, 0, 0), Vec3(0.1, 0, 0.02), 0.004));
    run_until(*solver, 0.03);
    const double top = top_of(solver->state()) + 0.002;
    ParticleBatch block = slab(2, seed, Vec3(0, 0, top), Vec3(0.06, 0, top + 0.02), 0.004);
    block.event = 2;
    block.velocity.x() = 0.2;
    solver->add(block);
    run_until(*solver, 0.03 + 0.2 / (9.81 * 0.5 / std::sqrt(3.0)));
    remaining_speed += momentum_of(solver->state(), 2).x() / block.total_mass() / 8;
  }
  EXPECT_LT(remaining_speed, 0.01);
}

/// Blocks that collide fast do not penetrate each other.
TEST(EventContacts, FastSnowDoesNotPenetrateSnowOfAnotherEvent) {
  const auto solver = weightless_solver();
  ParticleBatch lower = filled_box(2, Vec3(0, 0, 0), Vec3(0.06, 0, 0.03), 0.004);
  ParticleBatch upper = filled_box(2, Vec3(0, 0, 0.06), Vec3(0.06, 0, 0.09), 0.004);
  lower.event = 1;
  upper.event = 2;
  upper.velocity.z() = -5;
  solver->add(lower);
  solver->add(upper);
  double nearest = 1;  // m, of the two blocks along z
  while (solver->time() < 0.012) {
    run_steps(*solver, 4);
    const ParticleState s = solver->state();
    double top = -1, bottom = 1;
    for (std::size_t i = 0; i < s.positions.size(); ++i)
      if (s.events[i] == 1)
        top = std::max(top, s.positions[i].z());
      else
        bottom = std::min(bottom, s.positions[i].z());
    nearest = std::min(nearest, bottom - top);
  }
  EXPECT_GT(nearest, 0.001);  // they touch at 0.6 of the spacing
}

TEST(EventContacts, ABlockFeelsItsFrictionInThreeDimensions) {
  const double coefficient = 0.5 / std::sqrt(3.0);
  EXPECT_NEAR(mean_friction_coefficient(3, 0.01, 1, 2), coefficient, 0.07 * coefficient);
  EXPECT_LT(mean_friction_coefficient(3, 0.01, 0, 2), 0.03);
}

TEST(EventContacts, PairsAndTriplesKeepMomentum) {
  for (const SolverVariant& variant :
       {SolverVariant{2, Precision::float32}, SolverVariant{2, Precision::float64},
        SolverVariant{3, Precision::float32}, SolverVariant{3, Precision::float64}}) {
    Options o = event_options(variant);
    o.gravity = 0;
    o.energy = true;
    const auto solver = make_solver(o, {});
    const double velocities[3][3] = {{1, 0, 0.2}, {-1, 0.3, 0}, {0.1, -0.2, -2}};
    double speeds = 0;
    for (int event = 1; event <= 3; ++event) {
      const double x = event == 2 ? 0.032 : 0.0, z = event == 3 ? 0.032 : 0.0;
      ParticleBatch block =
          slab(variant.dimension, event, Vec3(x, 0, z), Vec3(x + 0.03, 0.03, z + 0.03), 0.005);
      block.velocity = Eigen::Map<const Vec3>(velocities[event - 1]);
      if (variant.dimension == 2) block.velocity.y() = 0;
      speeds += block.total_mass() * block.velocity.norm();
      solver->add(block);
    }
    const Vec3 before = momentum(solver->state()), first_before = momentum_of(solver->state(), 1);
    run_steps(*solver, 120);
    const ParticleState s = solver->state();
    EXPECT_LT((momentum(s) - before).norm(), 120 * variant.epsilon() * speeds) << variant.name();
    EXPECT_GT((momentum_of(s, 1) - first_before).norm(), 0.1 * first_before.norm())
        << variant.name();
    const EnergyBalance e = energy_of(*solver);
    EXPECT_GT(e.impact, 0.01 * e.added) << variant.name();
    EXPECT_GE(e.friction, 0) << variant.name();
    EXPECT_NEAR(e.residual(), 0, 0.05 * e.added) << variant.name();
  }
}

class EventContactsCheckpoint : public io::TemporaryFolder {};

std::unique_ptr<Solver> falling_slabs(int threads, int events) {
  Options o = event_options({2, Precision::float32});
  o.settings.threads = threads;
  o.settings.sleep_speed = 0.02;
  auto solver = make_solver(o, {ground()});
  for (int event = 1; event <= events; ++event)
    solver->add(
        slab(2, event, Vec3(-0.15, 0, 0.032 * event), Vec3(0.15, 0, 0.032 * event + 0.02), 0.004));
  return solver;
}

TEST_F(EventContactsCheckpoint, ThreadsAndResumingDoNotChangeTheBits) {
  const auto single = falling_slabs(1, 3), several = falling_slabs(3, 3);
  for (Solver* solver : {single.get(), several.get()}) {
    run_steps(*solver, 4500);
    while (!solver->at_safe_point()) solver->step();
  }
  expect_same_bits(snow_state(*several), snow_state(*single));
  EXPECT_GT(single->slept_updates(), 0);
  expect_resumes(*single, *falling_slabs(1, 3), path("state"), 200);
}

TEST_F(EventContactsCheckpoint, NewSnowAfterLoadingHasItsOwnField) {
  const auto before = weightless_solver(), solver = weightless_solver();
  before->add(lower_block(1));
  io::BinaryWriter out;
  before->save(out);
  out.save(path("state"));
  solver->load(io::BinaryReader::load(path("state")));
  solver->add(upper_block(2));
  EXPECT_NEAR(speed_carried_along(*solver, 1), 0, 0.002);
}

TEST_F(EventContactsCheckpoint, SlidingSnowResumesToTheSameBits) {
  const auto solver = falling_slabs(1, 0);
  solver->add(slab(2, 1, Vec3(-0.02, 0, 0), Vec3(0.1, 0, 0.02), 0.004));
  ParticleBatch block = slab(2, 2, Vec3(0, 0, 0.02), Vec3(0.06, 0, 0.04), 0.004);
  block.velocity.x() = 0.5;
  solver->add(block);
  run_steps(*solver, 600);
  while (!solver->at_safe_point()) solver->step();
  expect_resumes(*solver, *falling_slabs(1, 0), path("state"), 200);
}

// Contacts between sleeping slabs are found with the sums of idle nodes.
TEST_F(EventContactsCheckpoint, ABlockThatWakesTwoSlabsResumesToTheSameBits) {
  const auto solver = falling_slabs(1, 2);
  run_until(*solver, 0.5);
  EXPECT_LT(solver->motion(0).rms_speed, 1e-6);
  ParticleBatch block = slab(2, 3, Vec3(-0.19, 0, 0), Vec3(-0.152, 0, 0.04), 0.004);
  block.velocity.x() = 2;
  solver->add(block);
  while (!solver->at_safe_point()) solver->step();
  expect_resumes(*solver, *falling_slabs(1, 0), path("state"), 400);
  EXPECT_GT(momentum_of(solver->state(), 1).norm(), 0);
  EXPECT_GT(momentum_of(solver->state(), 2).norm(), 0);
}

/// Two blocks that collide, shifted by some cells of the grid and back again.
std::vector<Vec3> after_collision(int dimension, int cells) {
  Options o = event_options({dimension, Precision::float64});
  o.gravity = 0;
  o.settings.event_friction = 0;  // friction is shared out among the nodes of a block
  const Vec3 shift = cells * o.settings.dx * Vec3(1, dimension == 3, 1);
  const auto solver = make_solver(o, {});
  ParticleBatch lower = slab(dimension, 1, Vec3(0, 0, 0), Vec3(0.05, 0.03, 0.02), 0.004);
  ParticleBatch upper = slab(dimension, 2, Vec3(0.013, 0, 0.022), Vec3(0.04, 0.03, 0.04), 0.004);
  upper.velocity = Vec3(0.3, 0, -0.5);
  for (ParticleBatch* batch : {&lower, &upper}) {
    for (Vec3& x : batch->positions) x += shift;
    solver->add(*batch);
  }
  run_steps(*solver, 100);
  const ParticleState s = solver->state();
  EXPECT_GT(momentum_of(s, 1).norm(), 0.05 * momentum(s).norm());
  std::vector<Vec3> positions;
  for (const Vec3& x : s.positions) positions.push_back(x - shift);
  return positions;
}

TEST(EventContacts, APlaceWithinABlockOfNodesDoesNotMatter) {
  for (const int dimension : {2, 3}) {
    const std::vector<Vec3> unshifted = after_collision(dimension, 0);
    for (int cells = 1; cells < block_edge<3>; ++cells) {
      const std::vector<Vec3> shifted = after_collision(dimension, cells);
      ASSERT_EQ(shifted.size(), unshifted.size());
      double largest = 0;
      for (std::size_t i = 0; i < shifted.size(); ++i)
        largest = std::max(largest, (shifted[i] - unshifted[i]).norm());
      EXPECT_LT(largest, 1e-8) << dimension << "D, " << cells << " cells";
    }
  }
}

/// There are more events than fields. The oldest share a field.
TEST(EventContacts, MoreEventsThanFieldsMayMeet) {
  const auto solver = falling_slabs(1, 12);
  run_steps(*solver, 300);
  for (const Vec3& x : solver->state().positions) ASSERT_TRUE(x.allFinite());
  EXPECT_EQ(solver->state().events.back(), 12);
}

TEST(EventContacts, BlockKeysStoreTheField) {
  for (const int field : {0, 1, 7, max_fields - 1}) {
    const std::int32_t limit = block_coord_limit(field);
    for (const BlockCoord<3>& c :
         {BlockCoord<3>{0, 0, 0}, BlockCoord<3>{limit, -limit, 5}, BlockCoord<3>{-1, 2, -limit}}) {
      const BlockKey key = block_key<3>(c, field);
      EXPECT_EQ(field_of(key), field);
      EXPECT_EQ(block_coord<3>(key), c);
    }
    EXPECT_EQ(block_coord<2>(block_key<2>({limit, -limit}, field)), (BlockCoord<2>{limit, -limit}));
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm
