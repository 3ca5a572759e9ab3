// MPM coupled with another solver: a block of snow falls through wind. Every 0.01 s the program
// reads the velocities of the snow and adds the effect of the drag. Halfway it writes a checkpoint.
// A second solver continues from the checkpoint, and must end with the same bits as the first.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/advance.hpp"
#include "snowshed/methods/mpm/solver.hpp"

using namespace snowshed;

/// The other solver: the wind accelerates each particle to its own speed within some 0.2 s.
void add_drag(methods::Method& snow, double duration) {
  const Vec3 wind(2, 0, 0);            // m/s
  const double relaxation_time = 0.2;  // s
  const double share = -std::expm1(-duration / relaxation_time);
  const particles::FieldView velocity = snow.field("velocity");  // in the order of storage
  std::vector<Vec3> changes;                                     // ordered by id
  for (const std::uint32_t index : snow.order_by_id())
    changes.push_back(share * (wind - Vec3::Map(velocity.at<double>(index))));
  snow.add_velocity(changes);
}

void run_coupled(methods::Method& snow, double end) {
  const double interval = 0.01;  // s
  while (snow.time() < end) {
    const double start = snow.time();
    methods::advance_to(snow, start + interval);
    add_drag(snow, snow.time() - start);
  }
}

void save(methods::Method& snow, const std::string& file) {
  while (!snow.at_safe_point()) snow.step();  // only then the same bits follow
  io::BinaryWriter archive;
  snow.save(archive);
  archive.save(file);
}

std::unique_ptr<methods::Method> make_solver() {
  methods::mpm::Options options;
  options.dimension = 2;
  options.settings.dx = 0.02;  // m
  return methods::mpm::make_solver(options);
}

int main() {
  const std::string file = "embed_coupling.bin";
  methods::ParticleBatch block;
  const double distance = 0.01;  // m, between particles
  for (double x = 0.005; x < 0.1; x += distance)
    for (double z = 0.005; z < 0.1; z += distance) block.positions.emplace_back(x, 0, z);
  block.mass = 210 * distance * distance;  // kg, per metre of width; 210 kg/m3 is the default

  try {
    const auto first = make_solver(), second = make_solver();
    first->add(block);
    run_coupled(*first, 0.5);
    save(*first, file);
    run_coupled(*first, 1);

    second->load(io::BinaryReader::load(file));
    run_coupled(*second, 1);

    const methods::ParticleState a = first->state(), b = second->state();
    const bool same_bits = a.positions == b.positions && a.velocities == b.velocities;
    const Vec3 velocity = a.velocities.front();
    std::printf("%.2f m/s with the wind, %.2f m/s down; the same after the checkpoint: %s\n",
                velocity.x(), -velocity.z(), same_bits ? "yes" : "no");
    return same_bits && velocity.x() > 1.9 && velocity.x() < 2 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
