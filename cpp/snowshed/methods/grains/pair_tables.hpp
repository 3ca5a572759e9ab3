// The list of near pairs, and the data that follow from it.
#pragma once

#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {

/// A list of pairs and the arrays whose sizes depend on it.
struct PairTables {
  PairList pairs;
  std::vector<GrainPose> poses;
  BodyGroups groups_by_body;
  std::vector<GroupForce> results;
  double max_step;  // s
};

/// Searches for the near pairs of these poses. Contacts in the history keep their state.
PairTables search_pairs(const Model&, std::vector<GrainPose>, const Boundary&,
                        const std::vector<PairHistory>&);

/// The pairs that are bonded at the beginning: the bonds of the sample, pairs across the sides of a
/// periodic sample, and, if plates are bonded, the pairs that touch a plate.
std::vector<PairHistory> initial_bonds(const Model&, const std::vector<GrainPose>&,
                                       const Boundary&);

/// Poses of the grains in a state, or at the beginning.
std::vector<GrainPose> poses_of(const std::vector<GrainBody>&);

}  // namespace snowshed::methods::grains
