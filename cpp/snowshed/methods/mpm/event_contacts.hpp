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

#include <cstdint>
#include <vector>

#include "snowshed/methods/mpm/event_reach.hpp"
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

  /// Finds the contacts of the pairs whose snow may have moved far enough to change them, in the
  /// last step and before. The grid's sums must be up to date, those of idle nodes too.
  void update(const Model<T, D>& model, State<T, D>& state, Grid<T, D>& grid, int threads);

  std::ptrdiff_t overlap_count(const BlockLayout<D>& layout) const {
    return std::ptrdiff_t(layout.overlap_first.size()) - 1;
  }

  bool any(std::ptrdiff_t overlap) const {
    return first_[first_pair_[overlap]] < first_[first_pair_[overlap + 1]];
  }

  /// Exchanges the impulses of a step in an overlap.
  void exchange(const Model<T, D>& model, const StepParameters<T>& step, State<T, D>& state,
                Grid<T, D>& grid, std::ptrdiff_t overlap) const;

 private:
  static constexpr int B = block_edge<D>;
  using Contacts = std::vector<EventContact<T>>;
  /// Two blocks of an overlap: indices of BlockLayout::overlap_blocks.
  struct Pair {
    std::int32_t first, second;
  };
  /// Earlier contacts in the order of their keys.
  struct SortedContacts {
    const EventContact<T>*begin, *end;
    /// The contact with the same key, or null.
    const EventContact<T>* find(const EventContact<T>& contact) const;
  };
  /// The masses at the nodes of the blocks of an overlap and of the margins around them, once they
  /// are needed.
  using Masses = std::vector<std::vector<T>>;

  void find_due(const State<T, D>& state, const Grid<T, D>& grid, double dx);
  double fastest_around(const State<T, D>& state, const Grid<T, D>& grid,
                        std::int32_t grid_block) const;
  std::vector<T> masses_of(Grid<T, D>& grid, std::int32_t block) const;
  void find_reach(const Model<T, D>& model, const State<T, D>& state, Grid<T, D>& grid,
                  std::int32_t block, const SharedNodes<T, D>& nodes, ReachMap<T, D>& reach) const;
  void measure(const Model<T, D>& model, const State<T, D>& state, Grid<T, D>& grid,
               const SortedContacts& before, const Pair& pair, std::vector<T>& first_masses,
               std::vector<T>& second_masses, Contacts& contacts) const;
  void exchange(const Model<T, D>& model, const StepParameters<T>& step, Grid<T, D>& grid,
                EventContact<T>* begin, EventContact<T>* end) const;
  EventImpulses<T, D> impulses_at(const StepParameters<T>& step, T friction,
                                  const T* const (&sums)[2], T* const (&velocities)[2],
                                  EventContact<T>& contact) const;

  int support_;
  std::vector<T> radius_;  // radius of each particle, cells
  /// For each block of an overlap, the blocks of its field's nodes around it, or -1.
  std::vector<typename BlockLayout<D>::Neighbours> nodes_around_;
  std::vector<Pair> pairs_;                  // overlap by overlap
  std::vector<std::int32_t> first_pair_{0};  // first pair of each overlap
  std::vector<std::int32_t> first_{0};       // first contact of each pair
  std::vector<double> travel_;               // m, of the snow of each pair since it was measured
  std::vector<double> fastest_;              // m/s, of the snow at each block of an overlap
  std::vector<std::uint8_t> due_;            // whether each pair must be measured
  bool measured_ = false;
};

}  // namespace snowshed::methods::mpm
