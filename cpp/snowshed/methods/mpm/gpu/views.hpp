// Arrays and numbers in the memory of a device, as its kernels and the host see them. Node (i, j,
// k) of a block of 4^3 nodes has the index 16 i + 4 j + k.
#pragma once

#include <cstdint>

#include "snowshed/methods/mpm/contact.hpp"
#include "snowshed/methods/mpm/snow_constants.hpp"
#include "snowshed/methods/mpm/step_energies.hpp"

namespace snowshed::methods::mpm::gpu {

inline constexpr int edge = 4, nodes_of_block = 64, neighbours = 27;

/// Threads of a thread block that treats a block of particles, and of one for a block of nodes.
inline constexpr unsigned particle_threads = 128, node_threads = nodes_of_block;

/// Particles, sorted by blocks; see mpm::ParticleView.
struct ParticleArrays {
  float *cell[3], *velocity[3], *affine[9], *be_minus_identity[6];  // affine: null with FLIP
  float* plastic;                                                   // null with elastic snow alone
  const float* mass;
  const std::uint8_t* material_id;  // null with one snow
};

/// Blocks of particles: block b has the particles [first[b], first[b + 1]), and around[27 b + k] is
/// the k-th block of nodes around it.
struct BlockTable {
  const std::int32_t *first, *around;
};

/// Four numbers that are read and written together.
struct alignas(16) Quad {
  float x, y, z, w;
};
struct alignas(8) Pair {
  float x, y;
};

/// Sums that a node gets: mass, momentum (3) and force (3), as whole multiples of a unit.
inline constexpr int node_sums = 7, node_stride = 8;

/// Nodes of the grid.
struct GridArrays {
  unsigned long long* integers;      // sums of the awake snow, `node_stride` for each node
  const unsigned long long* asleep;  // sums of the snow that sleeps; null if none may
  Quad *carried, *force;             // mass and momentum; force
  Quad* velocity;                    // new velocity, and the change of its first component
  Pair* change;                      // changes of the other two
  float* ranges;  // for each block, the least new velocity (3) and the largest (3)
};

struct ContactArrays {
  const std::int32_t* first;                // block g has the contacts [first[g], first[g + 1])
  Contact<float>* contacts;                 // those with one obstacle follow each other
  const std::int32_t* conditions;           // one for each obstacle
  const float *friction, *friction_shares;  // one for each obstacle
};

/// The record of forces; null pointers if forces are not recorded.
struct ForceArrays {
  ContactForce<float>* contacts;  // one for each of the contacts
  float* blocks;                  // impulses (3) of blocks of nodes with a single obstacle, N s
  double* steps;                  // `recorded_values` of each step since the host looked
};

/// The balance of energy; null pointers if it is not kept.
struct EnergyArrays {
  ParticleEnergies *particles, *blocks;  // for each particle; sums over each block of them
  NodeEnergies* nodes;                   // sums over each block of nodes in the step being tried
  StepEnergies* steps;                   // sums over each step since the host looked
};

/// Values of a step in the record of forces: its end and its length (s), and the impulse (3) of
/// each obstacle on the snow, N s.
constexpr int recorded_values(int obstacles) { return 2 + 3 * obstacles; }

/// Sums of a coarse node, over which velocities are averaged: mass and momentum (3).
inline constexpr int average_sums = 4;

/// The coarse nodes around a block of particles.
struct AverageBlock {
  float origin[3];        // origin of the block past the first node, in spacings
  std::int32_t shift[3];  // the first node in the first coarse block
  std::int32_t count[3];  // coarse blocks along each direction
};

/// The coarse grid; null pointers if there is none.
struct AverageArrays {
  const AverageBlock* blocks;    // one for each block of particles
  const std::int32_t* around;    // the coarse blocks of each
  std::int32_t around_size;      // room for those of a block
  std::int32_t edge;             // coarse nodes around a block along each direction
  float per_cell;                // dx over the spacing
  unsigned long long* integers;  // sums of the awake snow, as whole multiples of a unit
  unsigned long long* asleep;    // sums of the sleeping snow; null if none may sleep
  Quad* mean;                    // mean velocities
};

/// Two of the blocks of nodes that several events have at the same position, as indices into
/// EventArrays::blocks.
struct EventPair {
  std::int32_t first, second;
};

/// A node of a pair. It is a contact if the snow touches, or has separated and friction is still
/// due; see EventContact.
struct EventNode {
  float normal[3];              // from the first field to the second
  float impulse, next_impulse;  // N s
  std::int32_t touches;
};

/// Positions at which several events have blocks of nodes. Position o has the blocks
/// [first_block[o], first_block[o + 1]) and the pairs [first_pair[o], first_pair[o + 1]).
struct EventArrays {
  const std::int32_t *first_block, *blocks, *first_pair;
  const EventPair* pairs;
  const std::int32_t *nodes_around, *particles_around;  // the 27 blocks around each of `blocks`
  EventNode* nodes;                                     // 64 for each pair
  double* travel;                                       // travel of each pair, m (is_search_due)
  const float* radius;                                  // radii of all particles, cells
  float friction;                                       // Coulomb's coefficient
};

/// A snow before any deformation.
struct InitialSnow {
  double density, plastic_strain;  // kg/m3; volumetric
};

/// Arguments of the kernels of particles.
struct ParticleLaunch {
  ParticleArrays particles;
  BlockTable blocks;
  const std::int32_t* list;  // blocks of particles that take part
  GridArrays grid;
  std::int32_t* strays;          // room for all particles
  unsigned long long* integers;  // sums to which the particles are added
  AverageArrays average;
  float* fastest;  // m2/s2, of the fastest snow of each block in the last step; asleep: 0
  EnergyArrays energy;
};

/// Sums over the particles of a block, by which the host decides whether the block sleeps.
struct BlockMotion {
  double speed_squared, velocity[3];  // m2/s2, m/s
  double mass, carried, change[3];    // kg; of the nodes, see SleepingBlockMotion, times the mass
  float fastest;                      // m2/s2
  std::int32_t holds_its_snow;
};

/// The range of the cells in which the particles of a block lie, relative to the block.
struct CellRange {
  std::int32_t low[3], high[3];
};

enum class Phase : std::int32_t {
  waiting,   // for the host
  trying,    // the node velocities for a step of `dt` are due
  too_long,  // the step would strain a particle beyond the limit: a shorter one is due
  accepted,  // the particles move
  stuck,     // the time step fell below every use
  unsound    // a particle is not finite, or is strained beyond the limit
};

inline constexpr std::int32_t no_particle = 0x7fffffff;

/// The progress of a simulation. A round of kernels takes one step, or finds that it must be
/// shorter. The host looks on from time to time.
struct Control {
  double time, dt, last_dt;  // s; of the step being tried, and of the last one
  double until;              // s, at which the host wants to look
  double smallest_dt;        // s
  double travel;             // m, by the fastest snow since the host looked
  double travel_limit;       // m, after which the host must look
  double undamped_time;      // s, of the steps since velocities were last damped over a length
  std::int64_t steps, rejected, undamped_steps;
  Phase phase;
  std::int32_t repeated;         // whether the step being tried has been shortened
  std::int32_t steps_left;       // before the host must look
  std::int32_t taken;            // steps since the host looked
  std::int32_t must_sort;        // whether a particle is close to the end of the nodes around it
  std::int32_t low[3], high[3];  // range of the node velocities, see `ordered`
  float strain;                  // s^-1, largest velocity gradient that the particles would see
  float speed_squared;           // m2/s2, of the fastest snow in the last step
  float spin;                    // s^-1, largest component of an affine velocity in the last step
  float strain_of_step;          // strain in the step that failed
  std::int32_t unsound;          // the first particle that is not sound
  std::int32_t strays;           // particles whose nodes do not lie in the tile of their block
  float momentum_unit;           // kg m/s, of the sums of the last step
};

/// Sum of the largest distances of a node from a particle along the three directions, in cells.
inline constexpr float arm = 4.5f;

/// Constants of a run.
struct Constants {
  double elastic_limit, courant_factor, strain_limit, dx;
  double friction_memory, friction_reach;  // s, m
  double relaxation_time;                  // s, of stress beyond the yield surface
  double event_tolerance;  // m, travel after which contacts between events are sought again
  double average_rate, average_share;       // s^-1; 0: velocities are not damped over a length
  float gravity, flip_ratio, damping_rate;  // a negative rate: the ratio holds for each step
  float mass_unit, force_unit;              // kg, N
  MaterialConstants<float> snow;            // the only one
  const MaterialConstants<float>* snows;    // if there are several
};

}  // namespace snowshed::methods::mpm::gpu
