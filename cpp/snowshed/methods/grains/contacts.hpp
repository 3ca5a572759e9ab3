// The pairs of a list, one by one, for measurements between steps.
#pragma once

#include "snowshed/methods/grains/state.hpp"

namespace snowshed::methods::grains {

/// The place and direction of a pair's contact.
struct PairGeometry {
  double gap;         // m
  Vec3 normal;        // from the first to the second
  Vec3 arm_a, arm_b;  // m, from the centres of the bodies to the contact, in space
};

/// Contact of a sphere with its group's partner. `position_a` and `rotation_a` are the pose of the
/// sphere's grain. `second` is the pose of the partner if it is a grain, otherwise null.
PairGeometry pair_geometry(const Model&, const Boundary&, const PairList&, const PairGroup&,
                           std::size_t pair, const Vec3& position_a, const Mat3& rotation_a,
                           const GrainPose* second);

/// Calls visit(group, pair, geometry) for all pairs of a list, without the entries that fill up
/// groups.
template <class PoseOf, class Visit>
void for_each_listed_pair(const Model& model, const Boundary& boundary, const PairList& list,
                          const PoseOf& pose_of, const Visit& visit) {
  for (const PairGroup& g : list.groups) {
    const GrainPose first = pose_of(g.first);
    const Mat3 rotation = first.orientation.toRotationMatrix();
    const bool of_grain = g.second < model.grains.size();
    const GrainPose second = of_grain ? pose_of(g.second) : GrainPose{};
    for (std::size_t p = g.begin; p < g.end; ++p)
      if (list.is_pair(p))
        visit(g, p,
              pair_geometry(model, boundary, list, g, p, first.position, rotation,
                            of_grain ? &second : nullptr));
  }
}

inline GrainPose pose_of(const GrainBody& body) { return {body.position, body.orientation}; }

/// Calls visit(group, pair, geometry) for the pairs that touch now, or are bonded.
template <class Visit>
void for_each_touching(const Model& model, const State& state, const Visit& visit) {
  for_each_listed_pair(
      model, state.boundary, state.pairs,
      [&](std::uint32_t body) { return pose_of(state.bodies[body]); },
      [&](const PairGroup& g, std::size_t p, const PairGeometry& pair) {
        if (pair.gap < 0 || state.pairs.bonded[p]) visit(g, p, pair);
      });
}

}  // namespace snowshed::methods::grains
