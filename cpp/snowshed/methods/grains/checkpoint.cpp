// Saving and restoring grains. The list of pairs is found again from the poses at which it was
// made, so that any time is a safe point.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/grains/listing.hpp"
#include "snowshed/methods/grains/solver_impl.hpp"

namespace snowshed {
namespace {

/// Calls visit(number) for all numbers of a body, in the order of the archive.
template <class Body, class Visit>
void for_each_number(Body& body, const Visit& visit) {
  const auto all = [&](auto& v) {
    for (int i = 0; i < 3; ++i) visit(v[i]);
  };
  all(body.position);
  all(body.velocity);
  for (int i = 0; i < 4; ++i) visit(body.orientation.coeffs()[i]);
  all(body.spin_momentum);
  all(body.force);
  all(body.torque);
  all(body.damping);
  all(body.spin_damping);
}
constexpr std::size_t numbers_of_body = 25, numbers_of_pose = 7;

constexpr std::size_t numbers_of_boundary = 39;

std::vector<double> numbers_of(const GrainsBoundary& b) {
  std::vector<double> values;
  GrainsBoundary::for_each_number(b, [&](double value) { values.push_back(value); });
  return values;
}

/// Reads numbers one after another.
struct NumberSource {
  const std::vector<double>& values;
  std::size_t next = 0;
  void operator()(double& value) { value = values[next++]; }
};

[[noreturn]] void refuse(const BinaryReader& in, const std::string& what) {
  throw InputError(in.path().string(), what);
}

void check_orientation(const BinaryReader& in, const Orientation& q) {
  if (!(std::abs(q.norm() - 1) < 1e-6)) refuse(in, "the orientation of a grain is not sound");
}

GrainsBoundary read_boundary(const BinaryReader& in, const char* name, const GrainsModel& model,
                             std::int64_t flags) {
  const std::vector<double> values = in.get<double>(name, numbers_of_boundary);
  GrainsBoundary b;
  NumberSource source{values};
  GrainsBoundary::for_each_number(b, [&](double& value) { source(value); });
  b.has_top = (flags & 1) != 0;
  b.has_cone = (flags & 2) != 0;
  const double far = 5e4 * model.radius + 10 * model.box.maxCoeff();
  for (const double value : numbers_of(b))
    if (!std::isfinite(value)) refuse(in, "what surrounds the grains is not sound");
  const Vec3 extent(b.period(0), b.period(1), b.plate[1].z() - b.plate[0].z());
  for (const Vec3& v : {b.plate[0], b.plate[1], b.tip, extent})
    if (!(v.cwiseAbs().maxCoeff() < far)) refuse(in, "a plate or the cone lies too far away");
  if (!(extent.minCoeff() > 0)) refuse(in, "the sides or plates have passed each other");
  return b;
}

std::vector<GrainBody> read_bodies(const BinaryReader& in, const GrainsModel& model,
                                   std::size_t count) {
  const std::vector<double> values = in.get<double>("grains/bodies", count * numbers_of_body);
  NumberSource source{values};
  std::vector<GrainBody> bodies(count);
  const double far = 5e4 * model.radius + 10 * model.box.maxCoeff();
  for (GrainBody& body : bodies) {
    for_each_number(body, [&](double& value) {
      source(value);
      if (!std::isfinite(value)) refuse(in, "the motion of a grain is not sound");
    });
    if (!(body.position.cwiseAbs().maxCoeff() < far)) refuse(in, "a grain lies too far away");
    check_orientation(in, body.orientation);
  }
  return bodies;
}

std::vector<GrainPose> read_poses(const BinaryReader& in, const GrainsModel& model,
                                  std::size_t count) {
  const std::vector<double> values = in.get<double>("grains/listed", count * numbers_of_pose);
  NumberSource source{values};
  std::vector<GrainPose> poses(count);
  const double far = 5e4 * model.radius + 10 * model.box.maxCoeff();
  for (GrainPose& pose : poses) {
    for (int i = 0; i < 3; ++i) source(pose.position[i]);
    for (int i = 0; i < 4; ++i) source(pose.orientation.coeffs()[i]);
    if (!(pose.position.cwiseAbs().maxCoeff() < far)) refuse(in, "a grain lay too far away");
    check_orientation(in, pose.orientation);
  }
  return poses;
}

std::vector<PairHistory> read_histories(const BinaryReader& in, const GrainsModel& model) {
  const auto keys = in.view<std::uint32_t>("pairs/keys");
  const auto shifts = in.view<std::int32_t>("pairs/shifts");
  const auto shear = in.view<double>("pairs/shear");
  const auto bonded = in.view<std::uint8_t>("pairs/bonded");
  const std::size_t n = bonded.size;
  if (keys.size != 4 * n || shifts.size != 2 * n || shear.size != 3 * n)
    refuse(in, "the pairs are not complete");
  std::vector<PairHistory> past(n);
  const std::size_t grains = model.grains.size(), spheres = model.spheres.offsets.size();
  for (std::size_t p = 0; p < n; ++p) {
    PairHistory& h = past[p];
    h.key = {keys[4 * p],
             keys[4 * p + 1],
             {shifts[2 * p], shifts[2 * p + 1]},
             keys[4 * p + 2],
             keys[4 * p + 3]};
    for (int i = 0; i < 3; ++i) h.shear[i] = shear[3 * p + std::size_t(i)];
    h.bonded = bonded[p] == 1;
    h.kept = true;
    const bool of_grain = h.key.second < grains;
    const bool sound =
        bonded[p] <= 1 && h.shear.allFinite() && h.key.a < spheres && h.key.first < grains &&
        model.spheres.grain[h.key.a] == h.key.first && h.key.second < grains + partners &&
        (!of_grain || (h.key.b < spheres && model.spheres.grain[h.key.b] == h.key.second)) &&
        (of_grain ? model.periodic() || (h.key.shift[0] == 0 && h.key.shift[1] == 0)
                  : h.key.shift[0] == 0 && h.key.shift[1] == 0) &&
        (!h.bonded || h.key.second < grains + std::size_t(Partner::west)) &&
        (p == 0 || past[p - 1].key < h.key);
    if (!sound) refuse(in, "a pair of spheres is not sound");
  }
  return past;
}

}  // namespace

void GrainsSolver::save(BinaryWriter& out) const {
  require_sound();
  std::vector<double> bodies, poses;
  for (const GrainBody& body : state_.bodies)
    for_each_number(body, [&](double value) { bodies.push_back(value); });
  for (const GrainPose& pose : state_.listed) {
    for (int i = 0; i < 3; ++i) poses.push_back(pose.position[i]);
    for (int i = 0; i < 4; ++i) poses.push_back(pose.orientation.coeffs()[i]);
  }
  out.add("grains/bodies", std::move(bodies));
  out.add("grains/listed", std::move(poses));
  out.add("grains/event", state_.events);
  std::vector<std::uint32_t> keys;
  std::vector<std::int32_t> shifts;
  std::vector<double> shear;
  std::vector<std::uint8_t> bonded;
  for (const PairHistory& h : state_.pairs.all()) {
    keys.insert(keys.end(), {h.key.first, h.key.second, h.key.a, h.key.b});
    shifts.insert(shifts.end(), {h.key.shift[0], h.key.shift[1]});
    for (int i = 0; i < 3; ++i) shear.push_back(h.shear[i]);
    bonded.push_back(h.bonded);
  }
  out.add("pairs/keys", std::move(keys));
  out.add("pairs/shifts", std::move(shifts));
  out.add("pairs/shear", std::move(shear));
  out.add("pairs/bonded", std::move(bonded));
  out.add("boundary/now", numbers_of(state_.boundary));
  out.add("boundary/listed", numbers_of(state_.listed_boundary));
  const LoadingProgress& l = state_.loading;
  std::vector<double> clock{state_.time,    state_.dt,  state_.counters.smallest_dt,
                            l.displacement, l.duration, l.peak_kinetic};
  GrainsEnergy::for_each_sum(state_.energy, [&](double sum) { clock.push_back(sum); });
  out.add("clock", std::move(clock));
  const auto flags = [](const GrainsBoundary& b) {
    return std::int64_t(b.has_top) + 2 * b.has_cone;
  };
  const StepCounters& c = state_.counters;
  out.add("counters",
          std::vector<std::int64_t>{std::int64_t(size()), c.steps, c.sorts, c.particle_updates,
                                    state_.bonds, state_.broken_in_tension, state_.broken_in_shear,
                                    std::int64_t(state_.first_id), std::int64_t(state_.next_id),
                                    std::int64_t(l.stage), flags(state_.boundary),
                                    flags(state_.listed_boundary), state_.boundary.top_contacts});
}

GrainsSolver::Restored GrainsSolver::restored(const BinaryReader& in) const {
  Restored result;
  GrainsState& next = result.state;
  const auto counts = in.get<std::int64_t>("counters", 13);
  if (counts[0] != 0 && counts[0] != std::int64_t(model_.grains.size()))
    refuse(in, std::to_string(counts[0]) + " grains; the sample has " +
                   std::to_string(model_.grains.size()));
  for (const std::int64_t count : counts)
    if (count < 0) refuse(in, "a counter is negative");
  const std::size_t grains = std::size_t(counts[0]);
  if (counts[9] > std::int64_t(model_.loading.size())) refuse(in, "there is no such stage");
  if (counts[7] + counts[0] > counts[8] || counts[8] > 0xffffffff) refuse(in, "ids are not sound");
  next.counters.steps = counts[1];
  next.counters.sorts = counts[2];
  next.counters.particle_updates = counts[3];
  next.bonds = counts[4];
  next.broken_in_tension = counts[5];
  next.broken_in_shear = counts[6];
  next.first_id = std::uint32_t(counts[7]);
  next.next_id = std::uint32_t(counts[8]);
  const std::vector<double> clock = in.get<double>("clock", 11);
  for (const double value : clock)
    if (!std::isfinite(value)) refuse(in, "the clock is not sound");
  next.time = clock[0];
  next.dt = clock[1];
  next.counters.smallest_dt = clock[2];
  next.loading = {int(counts[9]), clock[3], clock[4], clock[5]};
  std::size_t sum = 6;
  GrainsEnergy::for_each_sum(next.energy, [&](double& value) { value = clock[sum++]; });
  next.bodies = read_bodies(in, model_, grains);
  next.events = in.get<std::uint16_t>("grains/event", grains);
  next.boundary = read_boundary(in, "boundary/now", model_, counts[10]);
  next.listed_boundary = read_boundary(in, "boundary/listed", model_, counts[11]);
  next.boundary.top_contacts = counts[12];
  std::vector<GrainPose> poses = read_poses(in, model_, grains);
  const std::vector<PairHistory> past = read_histories(in, model_);
  if (grains == 0 && !past.empty()) refuse(in, "there are pairs without grains");
  if (std::int64_t(std::count_if(past.begin(), past.end(),
                                 [](const PairHistory& h) { return h.bonded; })) != next.bonds)
    refuse(in, "the number of bonds is not sound");

  GrainsWork& work = result.work;
  if (grains > 0) {
    Listing listing;
    try {
      listing = listing_of(model_, std::move(poses), next.listed_boundary, past);
    } catch (const SimulationError& error) {
      refuse(in, error.what());
    }
    next.pairs = std::move(listing.pairs);
    next.listed = std::move(listing.poses);
    work.groups_of = std::move(listing.groups_of);
    work.results = std::move(listing.results);
    work.longest_step = listing.longest_step;
    if (next.pairs.all().size() != past.size()) refuse(in, "pairs of near spheres are missing");
  }
  work.next = next.bodies;
  work.frames.resize(grains + 2);
  work.damped.resize(grains);
  return result;
}

void GrainsSolver::load(const BinaryReader& in) {
  Restored next = restored(in);
  std::vector<std::uint32_t> order(next.state.bodies.size());
  std::iota(order.begin(), order.end(), 0u);
  state_ = std::move(next.state);
  work_ = std::move(next.work);
  order_ = std::move(order);
  broken_ = false;
}

void GrainsSolver::check(const BinaryReader& in) const { restored(in); }

}  // namespace snowshed
