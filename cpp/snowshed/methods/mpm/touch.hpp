// Contact by touch: an obstacle holds a node only if a particle with weight at the node touches the
// obstacle. The given shape of the obstacle counts, not the thickened one that the grid sees.
// Otherwise snow would be held as soon as its splines reach the obstacle's nodes: a cell before it
// arrives, or past the obstacle's edge. The node pushes along the normal of the touched face. At
// the end of a plate the node's own normal would point along the plate, against snow that starts to
// slide.
//
// The distances are measured again when particles may have moved far enough for another one to
// touch. The radii stay those of the last sort of the particles.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm {

template <class T, int D>
class Touch {
 public:
  explicit Touch(Basis basis) : support_(support(basis)) {}

  /// Forgets all measurements. This is necessary after a change of the layout or of the order of
  /// the particles.
  void forget(const Model<T, D>& model, const State<T, D>& state);

  /// Decides for each contact whether it acts. `moved` is the distance (m) by which the fastest
  /// snow has moved since the last call.
  void update(const Model<T, D>& model, State<T, D>& state, double moved, int threads) {
    travel(moved);
    measure(model, state, due_blocks(model, state), threads);
  }

  // --- the parts of `update`, for particles in the memory of a device ---------------------------

  void travel(double moved) { travel_ += moved; }
  /// The blocks whose distances must be measured.
  std::vector<std::int32_t> due_blocks(const Model<T, D>& model, const State<T, D>& state) const;
  /// Measures the listed blocks, and decides for each contact at their nodes whether it acts. Looks
  /// at the particles of these blocks only.
  void measure(const Model<T, D>& model, State<T, D>& state,
               const std::vector<std::int32_t>& blocks, int threads);
  /// The distance (m) by which the fastest snow may move before a block must be measured.
  double reserve(const State<T, D>& state) const;

 private:
  /// A particle that touches an obstacle.
  struct TouchingParticle {
    std::int32_t particle, obstacle;
    std::array<int, D> lowest;  // its lowest node, counted from the first node of its block
    std::array<T, D> normal;    // normal of the obstacle where it touches
    bool operator==(const TouchingParticle& other) const {
      return std::tie(particle, obstacle, lowest, normal) ==
             std::tie(other.particle, other.obstacle, other.lowest, other.normal);
    }
  };
  struct Face {  // face of an obstacle that some particles touch
    std::array<T, D> normal;
    std::uint64_t nodes;  // a bit for each node where these particles have weight
    std::int32_t particles;
  };
  struct Block {
    std::vector<TouchingParticle> touching_particles;  // ordered by obstacle
    double next = 0;  // travel (m) at which distances are measured again
  };

  bool all_due(const Model<T, D>& model) const { return !measured_ || model.boundary.any_motion(); }
  bool measure(const Model<T, D>& model, const State<T, D>& state, std::int32_t block);
  std::vector<std::int32_t> due_particles(const Model<T, D>& model, const State<T, D>& state,
                                          std::int32_t block) const;
  double radius(const Model<T, D>& model, const State<T, D>& state, std::int32_t particle);
  void mark(const Model<T, D>& model, State<T, D>& state, std::int32_t grid_block) const;
  /// The faces of an obstacle that are touched by particles with weight in a block of nodes.
  std::vector<Face> faces(const BlockLayout<D>& layout, std::int32_t grid_block,
                          std::int32_t obstacle) const;

  int support_;
  std::vector<Block> blocks_;   // one per block of particles
  std::vector<double> next_;    // travel (m) at which each particle may touch an obstacle
  std::vector<double> radius_;  // radius of each particle, m; negative: not computed yet
  double largest_radius_ = 0;   // m, bound for all particles
  double travel_ = 0;           // distance (m) that the fastest snow has moved since `forget`
  bool measured_ = false;
};

}  // namespace snowshed::methods::mpm
