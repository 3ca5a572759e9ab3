// Saving and restoring grains. The list of pairs is made again from the poses of the last search,
// so that any time is a safe point.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/archive.hpp"
#include "snowshed/methods/grains/pair_tables.hpp"
#include "snowshed/methods/grains/solver_impl.hpp"

namespace snowshed::methods::grains {
namespace {

/// A pair of spheres in an archive.
struct StoredPair {
  std::array<std::uint32_t, 4> key;  // bodies, spheres
  std::array<std::int32_t, 2> shift;
  Vec3 shear;
  std::uint8_t bonded;
};

/// Contents of an archive that the state holds in another form.
struct CheckpointParts {
  std::vector<StoredPair> pairs;
  std::vector<Boundary> now, searched;  // one each
  std::int64_t grains = 0, flags = 0, searched_flags = 0;
};

template <class Archive, class State, class StoredParts>
void visit_state(Archive& archive, State& s, StoredParts& stored) {
  const std::size_t grains = archive.size("grains/event", s.events);
  const auto each = [](auto& vector, const auto& number) {
    for (int i = 0; i < vector.size(); ++i) number(vector[i]);
  };
  archive.packed("grains/bodies", s.bodies, grains, [&](auto& body, const auto& number) {
    each(body.position, number);
    each(body.velocity, number);
    each(body.orientation.coeffs(), number);
    each(body.spin_momentum, number);
    each(body.force, number);
    each(body.torque, number);
    each(body.damping, number);
    each(body.spin_damping, number);
  });
  archive.packed("grains/listed", s.searched_poses, grains, [&](auto& pose, const auto& number) {
    each(pose.position, number);
    each(pose.orientation.coeffs(), number);
  });
  archive.array("grains/event", s.events, grains);
  archive.columns(stored.pairs, column("pairs/keys", &StoredPair::key),
                  column("pairs/shifts", &StoredPair::shift),
                  column("pairs/shear", &StoredPair::shear),
                  column("pairs/bonded", &StoredPair::bonded));
  const auto numbers = [](auto& b, const auto& number) { Boundary::for_each_number(b, number); };
  archive.packed("boundary/now", stored.now, 1, numbers);
  archive.packed("boundary/listed", stored.searched, 1, numbers);
  auto& l = s.loading;
  auto& e = s.energy;
  archive.numbers("clock", s.time, s.dt, s.counters.smallest_dt, l.displacement, l.duration,
                  l.peak_kinetic, e.friction, e.damping, e.broken, e.boundary, e.added);
  auto& c = s.counters;
  archive.counts("counters", stored.grains, c.steps, s.pair_searches, c.particle_updates, s.bonds,
                 s.broken_in_tension, s.broken_in_shear, s.first_id, s.next_id, l.stage,
                 stored.flags, stored.searched_flags, s.boundary.top_contacts);
}

std::int64_t flags_of(const Boundary& b) { return std::int64_t(b.has_top) + 2 * b.has_cone; }

double farthest(const Model& model) { return 5e4 * model.radius + 10 * model.box.maxCoeff(); }

Boundary checked_boundary(const StateReader& archive, Boundary b, std::int64_t flags,
                          const Model& model) {
  b.has_top = (flags & 1) != 0;
  b.has_cone = (flags & 2) != 0;
  const Vec3 extent(b.period(0), b.period(1), b.plate[1].z() - b.plate[0].z());
  for (const Vec3& v : {b.plate[0], b.plate[1], b.tip, extent})
    if (!(v.cwiseAbs().maxCoeff() < farthest(model)))
      archive.refuse("a plate or the cone lies too far away");
  if (!(extent.minCoeff() > 0)) archive.refuse("the sides or plates have passed each other");
  return b;
}

/// Checks bodies and poses.
template <class Poses>
void check_poses(const StateReader& archive, const Poses& poses, const Model& model) {
  for (const auto& pose : poses) {
    if (!(pose.position.cwiseAbs().maxCoeff() < farthest(model)))
      archive.refuse("a grain lies too far away");
    if (!(std::abs(pose.orientation.norm() - 1) < 1e-6))
      archive.refuse("the orientation of a grain is not sound");
  }
}

StoredPair stored(const PairHistory& h) {
  return {{h.key.first, h.key.second, h.key.a, h.key.b},
          {h.key.shift[0], h.key.shift[1]},
          h.shear,
          std::uint8_t(h.bonded)};
}

std::vector<PairHistory> checked_pairs(const StateReader& archive,
                                       const std::vector<StoredPair>& pairs, const Model& model) {
  std::vector<PairHistory> past;
  const std::size_t grains = model.grains.size(), spheres = model.spheres.offsets.size();
  for (const StoredPair& pair : pairs) {
    PairHistory h;
    h.key = {pair.key[0], pair.key[1], {pair.shift[0], pair.shift[1]}, pair.key[2], pair.key[3]};
    h.shear = pair.shear;
    h.bonded = pair.bonded == 1;
    h.always_listed = true;
    const bool of_grain = h.key.second < grains;
    const bool sound =
        pair.bonded <= 1 && h.shear.allFinite() && h.key.a < spheres && h.key.first < grains &&
        model.spheres.grain[h.key.a] == h.key.first && h.key.second < grains + partner_count &&
        (!of_grain || (h.key.b < spheres && model.spheres.grain[h.key.b] == h.key.second)) &&
        (of_grain ? model.periodic() || (h.key.shift[0] == 0 && h.key.shift[1] == 0)
                  : h.key.shift[0] == 0 && h.key.shift[1] == 0) &&
        (!h.bonded || h.key.second < grains + std::size_t(Partner::west)) &&
        (past.empty() || past.back().key < h.key);
    if (!sound) archive.refuse("a pair of spheres is not sound");
    past.push_back(h);
  }
  return past;
}

void check_counts(const StateReader& archive, const State& s, const CheckpointParts& stored,
                  const Model& model) {
  if (stored.grains != 0 && stored.grains != std::int64_t(model.grains.size()))
    archive.refuse(std::to_string(stored.grains) + " grains; the sample has " +
                   std::to_string(model.grains.size()));
  if (stored.grains != std::int64_t(s.bodies.size())) archive.refuse("grains are missing");
  if (s.loading.stage > int(model.loading.size())) archive.refuse("there is no such stage");
  if (s.first_id + stored.grains > std::int64_t(s.next_id)) archive.refuse("ids are not sound");
  if (stored.grains == 0 && !stored.pairs.empty()) archive.refuse("there are pairs without grains");
  const auto bonds = std::count_if(stored.pairs.begin(), stored.pairs.end(),
                                   [](const StoredPair& pair) { return pair.bonded != 0; });
  if (std::int64_t(bonds) != s.bonds) archive.refuse("the number of bonds is not sound");
}

}  // namespace

void SolverImpl::save(io::BinaryWriter& out) const {
  soundness_.require();
  CheckpointParts parts;
  for (const PairHistory& h : state_.pairs.all()) parts.pairs.push_back(stored(h));
  parts.now = {state_.boundary};
  parts.searched = {state_.searched_boundary};
  parts.grains = std::int64_t(size());
  parts.flags = flags_of(state_.boundary);
  parts.searched_flags = flags_of(state_.searched_boundary);
  StateWriter archive(out);
  visit_state(archive, state_, parts);
}

SolverImpl::LoadedState SolverImpl::read_state(const io::BinaryReader& in) const {
  const StateReader archive(in);
  LoadedState result;
  State& next = result.state;
  CheckpointParts parts;
  visit_state(archive, next, parts);
  check_counts(archive, next, parts, model_);
  check_poses(archive, next.bodies, model_);
  check_poses(archive, next.searched_poses, model_);
  const std::int64_t top_contacts = next.boundary.top_contacts;
  next.boundary = checked_boundary(archive, parts.now[0], parts.flags, model_);
  next.boundary.top_contacts = top_contacts;
  next.searched_boundary =
      checked_boundary(archive, parts.searched[0], parts.searched_flags, model_);
  const std::vector<PairHistory> past = checked_pairs(archive, parts.pairs, model_);

  Workspace& work = result.work;
  const std::size_t grains = next.bodies.size();
  if (grains > 0) {
    PairTables tables;
    try {
      tables = search_pairs(model_, std::move(next.searched_poses), next.searched_boundary, past);
    } catch (const SimulationError& error) {
      archive.refuse(error.what());
    }
    next.pairs = std::move(tables.pairs);
    next.searched_poses = std::move(tables.poses);
    work.groups_by_body = std::move(tables.groups_by_body);
    work.results = std::move(tables.results);
    work.max_step = tables.max_step;
    if (next.pairs.all().size() != past.size()) archive.refuse("pairs of near spheres are missing");
  }
  work.next = next.bodies;
  work.frames.resize(grains + 2);
  work.damped_energy.resize(grains);
  return result;
}

void SolverImpl::load(const io::BinaryReader& in) {
  LoadedState next = read_state(in);
  std::vector<std::uint32_t> order(next.state.bodies.size());
  std::iota(order.begin(), order.end(), 0u);
  state_ = std::move(next.state);
  workspace_ = std::move(next.work);
  order_ = std::move(order);
  soundness_ = {};
}

void SolverImpl::check(const io::BinaryReader& in) const { read_state(in); }

}  // namespace snowshed::methods::grains
