// MPM within another program, without scenes and files: a block of snow falls onto the ground.
// Prints the height of its centre every 0.1 s, and fails if the block does not come to rest there.
#include <cstdio>
#include <exception>

#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/primitives.hpp"
#include "snowshed/methods/advance.hpp"
#include "snowshed/methods/mpm/solver.hpp"

using namespace snowshed;

int main() {
  methods::mpm::Options options;
  options.dimension = 2;
  options.settings.dx = 0.02;  // m
  material::Snow snow;
  snow.density = 250;  // kg/m3
  options.snows = {snow};
  methods::Obstacle ground;
  ground.shape = geometry::make_plane(Vec3(0, 0, 0), Vec3(0, 0, 1));
  ground.law = {methods::Condition::separate, 0.3};
  options.obstacles = {ground};

  methods::ParticleBatch block;
  const double distance = 0.01;  // m, between particles
  for (double x = -0.095; x < 0.1; x += distance)
    for (double z = 0.305; z < 0.4; z += distance) block.positions.emplace_back(x, 0, z);
  block.mass = snow.density * distance * distance;  // kg, per metre of width

  try {
    const auto solver = methods::mpm::make_solver(options);
    solver->add(block);
    double height = 0;  // m
    for (int tenth = 0; tenth < 10; ++tenth) {
      methods::advance_to(*solver, 0.1 * tenth);
      const methods::ParticleState state = solver->state();
      height = 0;
      for (const Vec3& x : state.positions) height += x.z() / double(state.positions.size());
      std::printf("%.1f s: %.3f m\n", 0.1 * tenth, height);
    }
    return height > 0.04 && height < 0.06 ? 0 : 1;  // it is 0.1 m high, and hardly deforms
  } catch (const std::exception& error) {  // InputError: the options; SimulationError: the run
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
