// The balance of energy of the solver on a device.
#include <gtest/gtest.h>

#include "methods/mpm/gpu/gpu_testing.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

using snowshed::gpu::Turns;

Options with_balance() {
  Options o = options_on_gpu(dx);
  o.energy = true;
  return o;
}

Options damped_with_balance() {
  Options o = with_balance();
  o.settings.transfer = Transfer::affine_flip;
  o.settings.damping_rate = 200;
  o.settings.damping_length = dx;
  o.settings.crack_band_length = 2 * dx;
  return o;
}

Obstacle plane(Condition condition, double friction = 0, const Vec3& normal = Vec3::UnitZ()) {
  return fixed(geometry::make_plane(Vec3::Zero(), normal.normalized()), condition, friction);
}

ParticleBatch thrown_block(double height, const Vec3& velocity) {
  const Vec3 low(0.013, -0.021, height);
  ParticleBatch batch = filled_box(3, low, low + Vec3::Constant(4 * dx), dx / 2);
  batch.velocity = velocity;
  return batch;
}

/// The largest energy that was turned into another one.
double turnover(const EnergyBalance& e) {
  return std::max({e.added - e.gravitational, e.kinetic, e.spent()});
}

void expect_same_balance(const Solver& a, const Solver& b, double share) {
  const NamedEnergies x = a.energies(), y = b.energies();
  ASSERT_EQ(names_of(x), names_of(y));
  const double tolerance = share * turnover(energy_of(a));
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_NEAR(x[i].second, y[i].second, tolerance) << x[i].first;
}

void expect_closed(const Solver& solver, double share) {
  const EnergyBalance e = energy_of(solver);
  EXPECT_NEAR(e.residual(), 0.0, share * turnover(e));
}

struct Balances {
  std::unique_ptr<Solver> cpu, gpu;
  Balances(const Options& o, const std::vector<Obstacle>& obstacles)
      : cpu(make_solver(o, obstacles)), gpu(make_emulated(o, obstacles)) {}
  template <class F>
  void each(const F& f) {
    for (Solver* s : {cpu.get(), gpu.get()}) f(*s);
  }
  EnergyBalance on_gpu() const { return energy_of(*gpu); }
};

/// The particles leave the tile of their block, and some are alone in the air.
TEST(GpuEnergy, FreeFallTurnsHeightIntoSpeed) {
  const auto solver = make_emulated(with_balance(), {});
  const std::vector<Vec3> velocities{{60, 0, 0}, {-60, 40, 0}, {0, -50, 50}, {30, 30, -60}};
  constexpr double mass = 0.01;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    ParticleBatch lone;
    lone.positions = {Vec3(double(i), 0.013, 0.027)};
    lone.velocity = velocities[i];
    lone.mass = mass;
    solver->add(lone);
  }
  double given = 0;
  for (const Vec3& v : velocities) given += 0.5 * mass * v.squaredNorm();
  EXPECT_NEAR(energy_of(*solver).kinetic, given, 1e-6 * given);
  double expected = 0;
  for (int step = 0; step < 60; ++step) {
    solver->step();
    expected = 0;
    for (Vec3 v : velocities) {
      v.z() -= 9.81 * solver->time();
      expected += 0.5 * mass * v.squaredNorm();
    }
    EXPECT_NEAR(energy_of(*solver).kinetic, expected, 2e-6 * expected);
  }
  EXPECT_GT(std::abs(expected - given), 1e-3);
  EXPECT_NEAR(energy_of(*solver).spent(), 0.0, 1e-5 * expected);
}

TEST(GpuEnergy, ClosesAsOnTheProcessorOnEachKindOfObstacle) {
  for (const Condition condition : {Condition::sticky, Condition::slip, Condition::separate}) {
    SCOPED_TRACE(int(condition));
    Balances both(with_balance(),
                  {plane(condition, 0.3, Vec3(-0.5, 0.1, 1.0)),
                   fixed(geometry::make_sphere(Vec3(0.25, 0.1, 0.0), 0.15), condition, 0.5)});
    both.each([](Solver& s) {
      s.add(thrown_block(0.12, Vec3(1, 0, -2)));
      run_steps(s, 100);
    });
    expect_same_balance(*both.cpu, *both.gpu, 3e-5);
    expect_closed(*both.gpu, 0.03);  // a fast impact on coarse cells
    const EnergyBalance e = both.on_gpu();
    const double contact = condition == Condition::sticky ? e.sticking : e.friction;
    EXPECT_GT(contact, 0.01 * turnover(e));
    EXPECT_GT(e.plastic, 0.01 * turnover(e));
  }
}

TEST(GpuEnergy, ClosesWithDampingOverALength) {
  Balances both(damped_with_balance(), {plane(Condition::separate, 0.3)});
  both.each([](Solver& s) {
    s.add(thrown_block(0.02, Vec3(2, 0, -4)));
    s.advance(0.03);  // in many steps at a time
  });
  expect_same_balance(*both.cpu, *both.gpu, 3e-5);
  expect_closed(*both.gpu, 0.02);
  EXPECT_GT(both.on_gpu().damping, 0.01 * turnover(both.on_gpu()));
}

/// Steps that were too long, and their repeated contacts, do not count.
TEST(GpuEnergy, RejectedStepsCountNothing) {
  Options o = with_balance();
  o.settings.strain_limit = 0.01;
  Balances both(o, {plane(Condition::slip, 0.4)});
  both.each([](Solver& s) {
    s.add(thrown_block(0.005, Vec3(5, 0, -8)));
    run_steps(s, 40);
  });
  EXPECT_GT(both.gpu->counters().rejected, 0);
  expect_same_balance(*both.cpu, *both.gpu, 3e-5);
  expect_closed(*both.gpu, 0.02);
}

/// A block slides and falls on a layer of an earlier event.
TEST(GpuEnergy, CountsContactBetweenEvents) {
  Options o = with_balance();
  o.settings.fields = Fields::events;
  o.settings.event_friction = 1;
  Balances both(o, {plane(Condition::sticky)});
  both.each([](Solver& s) {
    ParticleBatch layer =
        filled_box(3, Vec3(-0.013, 0.007, 0.012), Vec3(0.287, 0.157, 0.112), dx / 2);
    layer.event = 1;
    ParticleBatch block = filled_box(3, Vec3(0.02, 0.031, 0.113), Vec3(0.17, 0.131, 0.213), dx / 2);
    block.event = 2;
    block.velocity = Vec3(2, 0, -1);
    s.add(layer);
    s.add(block);
    run_steps(s, 100);
  });
  expect_same_balance(*both.cpu, *both.gpu, 3e-5);
  expect_closed(*both.gpu, 0.02);
  EXPECT_GT(both.on_gpu().friction, 0.01 * turnover(both.on_gpu()));
}

/// Snow falls asleep with some motion left, and a stone falls onto it.
TEST(GpuEnergy, SleepingSnowKeepsItsEnergies) {
  Options o = with_balance();
  o.settings.sleep_speed = 2;
  o.settings.sleep_time = 0.01;
  Balances both(o, {plane(Condition::sticky)});
  both.each([](Solver& s) {
    s.add(filled_box(3, Vec3(0.013, 0.007, 0.012), Vec3(0.213, 0.207, 0.187), dx / 2));
    s.advance(0.1);
    EXPECT_GT(energy_of(s).sleep, 0);
    EXPECT_EQ(energy_of(s).kinetic, 0);
    EXPECT_GT(energy_of(s).elastic, 0);
    ParticleBatch stone = filled_box(3, Vec3(0.05, 0.05, 0.215), Vec3(0.15, 0.15, 0.315), dx / 2);
    stone.velocity = Vec3(0, 0, -4);
    s.add(stone);
    run_steps(s, 24);
    EXPECT_GT(s.slept_updates(), 0);
  });
  expect_same_balance(*both.cpu, *both.gpu, 3e-5);
}

TEST(GpuEnergy, HasTheSameBitsInWhateverOrderTheThreadsRun) {
  NamedEnergies balances[2];
  for (const Turns turns : {Turns::forwards, Turns::backwards}) {
    Options o = damped_with_balance();
    o.settings.fields = Fields::events;
    o.settings.strain_limit = 0.02;
    const auto solver = make_emulated(o, {plane(Condition::slip, 0.4)}, turns);
    solver->add(thrown_block(0.1, Vec3(4, 1, -6)));
    ParticleBatch other = thrown_block(0.31, Vec3(-3, 0, -12));
    other.event = 1;
    solver->add(other);
    run_steps(*solver, 70);  // with a sort
    EXPECT_GT(solver->counters().rejected, 0);
    balances[turns == Turns::backwards] = solver->energies();
  }
  EXPECT_EQ(balances[0], balances[1]);
}

/// The sums of one device go on on the other, and snow may be added on the way.
TEST(GpuEnergy, ContinuesOnTheOtherDevice) {
  const Options o = damped_with_balance();
  const std::vector<Obstacle> ground{plane(Condition::separate, 0.3)};
  for (const bool from_gpu : {false, true}) {
    SCOPED_TRACE(from_gpu);
    const auto first = from_gpu ? make_emulated(o, ground) : make_solver(o, ground);
    first->add(thrown_block(0.01, Vec3(2, 0, -4)));
    run_steps(*first, 30);
    const std::string file = testing::TempDir() + "gpu_energy.snow";
    io::BinaryWriter out;
    first->save(out);
    out.save(file);
    Balances next(o, ground);
    next.each([&](Solver& s) {
      s.load(io::BinaryReader::load(file));
      EXPECT_EQ(s.energies(), first->energies());
      run_steps(s, 10);
      s.add(thrown_block(0.23, Vec3(0, 0, -3)));
      run_steps(s, 20);
    });
    expect_same_balance(*next.cpu, *next.gpu, 3e-5);
    expect_closed(*next.gpu, 0.02);
  }
}

TEST(GpuEnergy, CostsNothingWithoutTheBalance) {
  for (const bool balance : {false, true}) {
    Options o = options_on_gpu(dx);
    o.energy = balance;
    o.obstacles = {plane(Condition::sticky)};
    const auto device = emulated_card();
    const auto solver = make_gpu_solver(std::move(o), device);
    solver->add(thrown_block(0.01, Vec3::Zero()));
    run_steps(*solver, 2);
    bool any = false;
    for (const auto& launched : device->launches())
      any = any || launched.first.find("energ") != std::string::npos;
    EXPECT_EQ(any, balance);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
