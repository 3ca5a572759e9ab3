// Where the snow of different events meets, when each has a velocity field of its own: blocks of
// nodes of two or more fields at one place. The fields exchange impulses at the nodes where a
// particle of one touches a particle of the other; elsewhere they do not feel each other.
//
// The impulse along the normal and the friction are those of the contact with obstacles
// (NodeKernels::apply): pushes fill a store, pulls empty it, friction is charged for the impulse
// that drains. Each impulse acts on the two fields of a pair with opposite signs, also where three
// or more meet.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/methods/mpm/grid.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::mpm {

template <class T, int D>
class Meetings {
 public:
  explicit Meetings(Basis basis) : support_(support(basis)) {}

  /// After a change of the layout or of the order of the particles: nothing is known any more.
  void forget(const Model<T, D>& model, const State<T, D>& state, int threads);

  /// Finds the contacts between the fields again, if snow may have moved far enough since the last
  /// time to change them. `moved` is the distance (m) by which the fastest snow has moved since the
  /// last call. The sums of active blocks must be present.
  void update(const Model<T, D>& model, State<T, D>& state, Grid<T, D>& grid, double moved,
              int threads);

  std::ptrdiff_t places(const BlockLayout<D>& layout) const {
    return std::ptrdiff_t(layout.meeting_first.size()) - 1;
  }

  /// Exchanges the impulses of a step at a place.
  void exchange(const StepParameters<T>& step, double friction, State<T, D>& state,
                Grid<T, D>& grid, std::ptrdiff_t place) const;

 private:
  static constexpr int B = block_edge<D>;
  /// Nodes on either side over which normals are smoothed. With fewer, snow that slides is braked
  /// by the roughness of two layers of particles; in three dimensions there are more of them.
  static constexpr int smoothing = D == 2 ? 6 : 3;
  static constexpr int margin = smoothing + 1;  // nodes around a block whose masses are needed
  static constexpr int padded_edge = B + 2 * margin;
  static constexpr int padded_nodes = padded_edge * padded_edge * (D == 3 ? padded_edge : 1);
  using Masses = std::vector<T>;  // masses of a field at the nodes of a place and around it
  static std::array<int, D> filled(int value) {
    std::array<int, D> index;
    index.fill(value);
    return index;
  }
  struct Nodes {               // nodes of a block that two fields share
    std::uint64_t shared = 0;  // a bit for each node
    std::array<int, D> begin = filled(B), end = filled(0);  // box around these
    T normal[64][3];                                        // from the first field to the second
    T first[64], second[64];  // reach of the fields along the normal, towards each other, cells
  };

  struct Impulses {  // impulses of a step at a node, N s
    T push;          // from the first field to the second, along the normal
    T friction;      // due
    T stopping;      // impulse that ends the slip
    T slip[D];       // its direction
  };
  using Stores = std::vector<const FieldContact<T>*>;  // in the order of names

  const T* sums_of(const State<T, D>& state, Grid<T, D>& grid, const Kernels<T>& kernels,
                   std::int32_t block, std::vector<T>& room) const;
  Masses masses_of(const State<T, D>& state, Grid<T, D>& grid, const Kernels<T>& kernels,
                   std::int32_t block) const;
  static void find_normals(const Masses& a, const Masses& b, Nodes& nodes);
  void find_reach(const Model<T, D>& model, const State<T, D>& state, std::int32_t block,
                  bool first, Nodes& nodes) const;
  void measure(const Model<T, D>& model, const State<T, D>& state, Grid<T, D>& grid,
               const Stores& before, std::ptrdiff_t place,
               std::vector<FieldContact<T>>& contacts) const;
  void exchange(const StepParameters<T>& step, T friction, Grid<T, D>& grid, FieldContact<T>* begin,
                FieldContact<T>* end) const;
  Impulses impulses_at(const StepParameters<T>& step, T friction, const T* const (&sums)[2],
                       T* const (&velocities)[2], FieldContact<T>& contact) const;

  int support_;
  std::vector<T> radius_;               // radius of each particle, cells
  std::vector<std::int32_t> first_{0};  // first contact of each place
  double since_measured_ = 0;           // m, that the fastest snow has moved
  bool measured_ = false;
};

}  // namespace snowshed::mpm
