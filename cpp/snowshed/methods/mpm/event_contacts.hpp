// Contacts between the snow of different events. Each event has a velocity field of its own. An
// overlap consists of the blocks of nodes of two or more fields at the same position. The fields
// exchange impulses at the nodes where particles of one field touch particles of the other. At
// other nodes they do not act on each other.
//
// The normal impulse and the friction follow the rules for contact with obstacles
// (push_and_rub): pushes add to a stored normal impulse, pulls subtract from it, and it
// decays. The part that has decayed gives the friction. Each impulse acts on the two fields of a
// pair with opposite signs. Three or more fields interact in pairs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "snowshed/methods/mpm/event_rule.hpp"
#include "snowshed/methods/mpm/grid.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm {

template <class T, int D>
class EventContacts {
 public:
  explicit EventContacts(Basis basis) : support_(support(basis)) {}

  /// Forgets all measurements. This is necessary after a change of the layout or of the order of
  /// the particles.
  void forget(const Model<T, D>& model, const State<T, D>& state, int threads);

  /// Finds the contacts between the fields if snow may have moved far enough to change them.
  /// `moved` is the distance (m) by which the fastest snow has moved since the last call. The sums
  /// of active blocks must be up to date.
  void update(const Model<T, D>& model, State<T, D>& state, Grid<T, D>& grid, double moved,
              int threads);

  std::ptrdiff_t overlap_count(const BlockLayout<D>& layout) const {
    return std::ptrdiff_t(layout.overlap_first.size()) - 1;
  }

  /// Exchanges the impulses of a step in an overlap.
  void exchange(const StepParameters<T>& step, double friction, State<T, D>& state,
                Grid<T, D>& grid, std::ptrdiff_t overlap) const;

 private:
  static constexpr int B = block_edge<D>;
  static constexpr int smoothing = normal_smoothing<D>;
  static constexpr int margin = normal_margin<D>;
  static constexpr int padded_edge = B + 2 * margin;
  static constexpr int padded_nodes = padded_edge * padded_edge * (D == 3 ? padded_edge : 1);
  using Masses = std::vector<T>;  // masses of a field at the nodes of a block and around it
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

  using SortedContacts = std::vector<const EventContact<T>*>;  // in the order of their keys

  const T* sums_of(const State<T, D>& state, Grid<T, D>& grid, const Kernels<T>& kernels,
                   std::int32_t block, std::vector<T>& buffer) const;
  Masses masses_of(const State<T, D>& state, Grid<T, D>& grid, const Kernels<T>& kernels,
                   std::int32_t block) const;
  static void find_normals(const Masses& a, const Masses& b, Nodes& nodes);
  void find_reach(const Model<T, D>& model, const State<T, D>& state, std::int32_t block,
                  bool first, Nodes& nodes) const;
  void measure(const Model<T, D>& model, const State<T, D>& state, Grid<T, D>& grid,
               const SortedContacts& before, std::ptrdiff_t overlap,
               std::vector<EventContact<T>>& contacts) const;
  void exchange(const StepParameters<T>& step, T friction, Grid<T, D>& grid, EventContact<T>* begin,
                EventContact<T>* end) const;
  EventImpulses<T, D> impulses_at(const StepParameters<T>& step, T friction,
                                  const T* const (&sums)[2], T* const (&velocities)[2],
                                  EventContact<T>& contact) const;

  int support_;
  std::vector<T> radius_;               // radius of each particle, cells
  std::vector<std::int32_t> first_{0};  // first contact of each overlap
  double since_measured_ = 0;           // distance (m) that the fastest snow has moved
  bool measured_ = false;
};

}  // namespace snowshed::methods::mpm
