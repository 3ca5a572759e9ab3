// Fields of events of the solver on a device: momentum, and the processor's motion.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

using snowshed::gpu::Turns;

Options with_fields(Fields fields = Fields::events) {
  Options o = options_on_gpu(dx);
  o.settings.fields = fields;
  return o;
}

std::vector<Obstacle> level_floor() {
  return {fixed(geometry::make_plane(Vec3::Zero(), Vec3::UnitZ()), Condition::separate, 0.4)};
}

ParticleBatch snow_of(int event, const Vec3& low, const Vec3& size,
                      const Vec3& velocity = Vec3::Zero()) {
  ParticleBatch batch = filled_box(3, low, low + size, dx / 2);
  batch.event = event;
  batch.velocity = velocity;
  return batch;
}

ParticleBatch layer() { return snow_of(1, Vec3(-0.013, 0.007, 0.012), Vec3(0.3, 0.15, 0.1)); }

/// A block close above the layer, that lands on it and slides.
ParticleBatch landing_block(int event = 2) {
  return snow_of(event, Vec3(0.02, 0.031, 0.125), Vec3(0.15, 0.1, 0.1), Vec3(2, 0, -3));
}

struct BothDevices {
  std::unique_ptr<Solver> cpu, gpu;
  template <class F>
  void each(const F& f) {
    for (Solver* s : {cpu.get(), gpu.get()}) f(*s);
  }
  double distance() const { return largest_distance(cpu->state(), gpu->state()); }
};

BothDevices on_both(const Options& o, const std::vector<Obstacle>& obstacles = level_floor()) {
  return {make_solver(o, obstacles), make_emulated(o, obstacles)};
}

Vec3 momentum_of(const ParticleState& s, int event) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < s.positions.size(); ++i)
    if (s.events[i] == event) sum += s.masses[i] * s.velocities[i];
  return sum;
}

TEST(GpuEvents, LandAndSlideOnEachOtherAsOnTheProcessor) {
  BothDevices events = on_both(with_fields()), single = on_both(with_fields(Fields::one));
  for (BothDevices* pair : {&events, &single})
    pair->each([](Solver& s) {
      s.add(layer());
      s.add(landing_block());
      run_steps(s, 120);
    });
  EXPECT_LT(events.distance(), 1e-5);
  EXPECT_GT(largest_distance(events.gpu->state(), single.gpu->state()), 1e-3);
}

/// The snows differ in density and hardness, on which the radii of particles depend.
TEST(GpuEvents, MayHaveSnowsOfTheirOwn) {
  Options o = with_fields();
  material::Snow heavy;
  heavy.density = 350;
  o.snows = {material::Snow(), heavy};
  BothDevices pair = on_both(o);
  pair.each([](Solver& s) {
    s.add(layer());
    ParticleBatch block = landing_block();
    block.mass *= 350.0 / 210;
    block.material_id = 1;
    s.add(block);
    run_steps(s, 100);
  });
  EXPECT_LT(pair.distance(), 1e-5);
}

/// The block slides on for many sorts, with the friction of the snow alone.
TEST(GpuEvents, SlideWithTheFrictionOfTheSnow) {
  Options o = with_fields();
  o.settings.event_friction = 1;
  double losses[2];  // m/s along x
  for (const bool on_card : {false, true}) {
    const auto solver = on_card ? make_emulated(o, level_floor()) : make_solver(o, level_floor());
    solver->add(layer());
    ParticleBatch block = landing_block();
    for (Vec3& x : block.positions) x.z() -= 0.012;
    block.velocity = Vec3(1, 0, 0);
    solver->add(block);
    solver->advance(0.05);
    losses[on_card] = 1 - momentum_of(solver->state(), 2).x() / block.total_mass();
  }
  EXPECT_GT(losses[0], 0.05);
  EXPECT_NEAR(losses[1], losses[0], 1e-3 * losses[0]);
}

TEST(GpuEvents, PairsAndTriplesKeepMomentum) {
  Options o = with_fields();
  o.gravity = 0;
  BothDevices pair = on_both(o, {});
  const Vec3 size(0.12, 0.12, 0.12), velocities[] = {{2, 0, 0.4}, {-2, 0.6, 0}, {0.2, -0.4, -4}};
  pair.each([&](Solver& s) {
    for (int event = 1; event <= 3; ++event)
      s.add(snow_of(event, Vec3(event == 2 ? 0.13 : 0, 0.01 * event, event == 3 ? 0.13 : 0), size,
                    velocities[event - 1]));
  });
  const ParticleState before = pair.gpu->state();
  pair.each([](Solver& s) { run_steps(s, 120); });
  const ParticleState after = pair.gpu->state();
  EXPECT_LT((momentum(after) - momentum(before)).norm(), 3e-6 * total_mass(after));
  for (int event = 1; event <= 3; ++event)
    EXPECT_GT((momentum_of(after, event) - momentum_of(before, event)).norm(),
              0.1 * momentum_of(before, event).norm());
  EXPECT_LT(pair.distance(), 1e-5);
}

/// Steps that are too long leave the stored impulses as they were.
TEST(GpuEvents, ShortenStepsAsOnTheProcessor) {
  Options o = with_fields();
  o.settings.strain_limit = 0.01;
  BothDevices pair = on_both(o);
  pair.each([](Solver& s) {
    s.add(layer());
    ParticleBatch block = landing_block();
    block.velocity = Vec3(3, 0, -6);
    s.add(block);
    run_steps(s, 60);
  });
  EXPECT_GT(pair.cpu->counters().rejected, 0);
  EXPECT_EQ(pair.gpu->counters().rejected, pair.cpu->counters().rejected);
  EXPECT_LT(pair.distance(), 1e-5);
}

/// The block falls onto a layer that sleeps, at first without waking it.
TEST(GpuEvents, SleepingSnowCarriesSnowOfAnotherEvent) {
  Options o = with_fields();
  o.settings.sleep_speed = 1;
  o.settings.sleep_time = 0.01;
  BothDevices pair = on_both(o);
  pair.each([](Solver& s) {
    s.add(layer());
    s.advance(0.08);
    EXPECT_GT(s.slept_updates(), 0);
    s.add(landing_block());
    run_steps(s, 50);
  });
  EXPECT_LT(pair.distance(), 1e-5);
  const ParticleState after = pair.gpu->state();
  double lowest = 1;
  for (std::size_t i = 0; i < after.positions.size(); ++i)
    if (after.events[i] == 2) lowest = std::min(lowest, after.positions[i].z());
  EXPECT_GT(lowest, 0.1);
}

TEST(GpuEvents, AllOfTheSchemeAgreesWithTheProcessor) {
  Options o = options_on_gpu(dx);
  o.settings.adopt(Scheme::objective);
  o.forces = true;
  BothDevices pair = on_both(o);
  Vec3 impulses[2];  // N s, of the second event
  pair.each([&](Solver& s) {
    ParticleBatch low = layer();
    for (Vec3& x : low.positions) x.z() -= 0.016;
    s.add(low);
    s.advance(0.02);
    s.begin_force_event();
    ParticleBatch block = landing_block();
    for (Vec3& x : block.positions) x.z() -= 0.016;
    s.add(block);
    s.advance(0.05);
    impulses[&s == pair.gpu.get()] = s.sample_forces(0.03)[0].impulse.total();
  });
  EXPECT_LT(pair.distance(), 1e-4);
  EXPECT_GT(impulses[0].norm(), 0.1);
  EXPECT_LT((impulses[1] - impulses[0]).norm(), 2e-3 * impulses[0].norm());
}

/// As reseeding between events does: other particles in the place of those that came to rest.
TEST(GpuEvents, SnowMayBeReplacedBetweenEvents) {
  BothDevices pair = on_both(with_fields());
  pair.each([](Solver& s) {
    s.add(layer());
    s.add(landing_block());
    run_steps(s, 30);
    ParticleBatch old_snow = filled_box(3, Vec3(0, 0, 0.01), Vec3(0.25, 0.2, 0.11), dx / 3);
    old_snow.event = 2;
    s.replace({old_snow});
    s.add(landing_block(3));
    run_steps(s, 50);
  });
  EXPECT_LT(pair.distance(), 1e-5);
}

/// With ten events, the first three share a field.
TEST(GpuEvents, MoreEventsThanFieldsMayMeet) {
  BothDevices pair = on_both(with_fields());
  pair.each([](Solver& s) {
    for (int event = 1; event <= 10; ++event)
      s.add(snow_of(event, Vec3(0.06 * event, 0, 0.01), Vec3(0.05, 0.05, 0.1),
                    Vec3(event % 2 ? 1 : -1, 0, 0)));
    run_steps(s, 60);
  });
  EXPECT_LT(pair.distance(), 1e-5);
}

/// The stored impulses of a checkpoint continue on either device.
TEST(GpuEvents, ContinueOnTheOtherDevice) {
  const std::string file = testing::TempDir() + "gpu_events.snow";
  for (const bool from_card : {false, true}) {
    SCOPED_TRACE(from_card);
    const auto first = from_card ? make_emulated(with_fields(), level_floor())
                                 : make_solver(with_fields(), level_floor());
    first->add(layer());
    first->add(landing_block());
    run_steps(*first, 80);
    io::BinaryWriter out;
    first->save(out);
    out.save(file);
    BothDevices resumed = on_both(with_fields());
    resumed.each([&](Solver& s) {
      s.load(io::BinaryReader::load(file));
      run_steps(s, 60);
    });
    run_steps(*first, 60);
    EXPECT_LT(resumed.distance(), 2e-6);
    EXPECT_LT(largest_distance(first->state(), resumed.gpu->state()), 2e-6);
  }
}

TEST(GpuEvents, HaveTheSameBitsInWhateverOrderTheThreadsRun) {
  SnowState states[2];
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    const auto solver = make_emulated(with_fields(), level_floor(), turns);
    solver->add(layer());
    solver->add(landing_block());
    solver->add(snow_of(3, Vec3(0.18, 0.031, 0.13), Vec3(0.1, 0.1, 0.1), Vec3(-1, 0, -1)));
    run_steps(*solver, 100);
    states[turns == Turns::backwards] = snow_state(*solver);
  }
  expect_same_bits(states[0], states[1]);
}

/// The search is part of a step only where events are near, and only when snow has moved.
TEST(GpuEvents, CostNothingWhereTheyAreFarFromEachOther) {
  std::size_t bytes[2];
  for (const Fields fields : {Fields::one, Fields::events}) {
    const auto device = emulated_card();
    Options o = with_fields(fields);
    o.obstacles = level_floor();
    const auto solver = make_gpu_solver(o, device);
    solver->add(layer());
    ParticleBatch far = landing_block();
    for (Vec3& x : far.positions) x.x() += 2;
    solver->add(far);
    run_steps(*solver, 10);
    EXPECT_EQ(device->launches().count("overlap_step"), 0u);
    EXPECT_EQ(device->launches().count("find_event_contacts"), 0u);
    EXPECT_EQ(device->launches().count("find_radii"), 0u);
    bytes[fields == Fields::events] = device->bytes_in_use();
  }
  EXPECT_LE(bytes[1], bytes[0] + 64);  // the snow's initial state
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
