#include "snowshed/methods/grains/pair_tables.hpp"

#include <algorithm>

#include "snowshed/methods/grains/contacts.hpp"
#include "snowshed/methods/grains/time_step.hpp"

namespace snowshed::methods::grains {
namespace {

PairSearch search_of(const Model& model) {
  const std::size_t spheres = model.spheres.offsets.size();
  return {model.spheres,      std::uint32_t(model.grains.size()),
          model.radius,       skin_per_radius * model.radius,
          model.periodic(),   model.cone,
          64 * spheres + 256, model.threads};
}

/// Whether a pair that touches at the beginning is continuous ice that the image's border cuts.
bool is_frozen(const Model& model, const PairKey& key) {
  const std::uint32_t grains = std::uint32_t(model.grains.size());
  if (key.second < grains) return key.shift[0] != 0 || key.shift[1] != 0;
  return model.settings.bonded_plates && key.second < grains + std::uint32_t(Partner::west);
}

}  // namespace

std::vector<GrainPose> poses_of(const std::vector<GrainBody>& bodies) {
  std::vector<GrainPose> poses;
  poses.reserve(bodies.size());
  for (const GrainBody& body : bodies) poses.push_back(pose_of(body));
  return poses;
}

PairTables search_pairs(const Model& model, std::vector<GrainPose> poses, const Boundary& boundary,
                        const std::vector<PairHistory>& past) {
  PairTables tables;
  const PairSearch search = search_of(model);
  tables.pairs = make_list(search, find_pairs(search, poses, boundary), past);
  tables.groups_by_body = groups_of_bodies(tables.pairs, poses.size());
  tables.results.resize(tables.pairs.groups.size());
  tables.max_step = max_step(model, boundary, tables.pairs, poses);
  tables.poses = std::move(poses);
  return tables;
}

std::vector<PairHistory> initial_bonds(const Model& model, const std::vector<GrainPose>& poses,
                                       const Boundary& boundary) {
  std::vector<PairHistory> bonds;
  for (const BondedPair& bond : model.bonds) {
    std::uint32_t a = bond.first, b = bond.second;
    if (model.spheres.grain[a] > model.spheres.grain[b]) std::swap(a, b);
    bonds.push_back(
        {{model.spheres.grain[a], model.spheres.grain[b], {0, 0}, a, b}, Vec3::Zero(), true, true});
  }
  if (model.periodic() || model.settings.bonded_plates) {
    const PairSearch search = search_of(model);
    const PairList near = make_list(search, find_pairs(search, poses, boundary), {});
    for_each_listed_pair(
        model, boundary, near, [&](std::uint32_t body) { return poses[body]; },
        [&](const PairGroup& g, std::size_t p, const PairGeometry& pair) {
          const PairKey key = near.key(g, p);
          if (std::abs(pair.gap) <= 1e-6 * model.radius && is_frozen(model, key))
            bonds.push_back({key, Vec3::Zero(), true, true});
        });
  }
  std::sort(bonds.begin(), bonds.end(),
            [](const PairHistory& x, const PairHistory& y) { return x.key < y.key; });
  bonds.erase(
      std::unique(bonds.begin(), bonds.end(),
                  [](const PairHistory& x, const PairHistory& y) { return x.key == y.key; }),
      bonds.end());
  return bonds;
}

}  // namespace snowshed::methods::grains
