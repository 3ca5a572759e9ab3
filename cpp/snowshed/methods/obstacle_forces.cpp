#include "snowshed/methods/obstacle_forces.hpp"

#include <algorithm>

#include "snowshed/methods/archive.hpp"

namespace snowshed::methods {
namespace {

/// The edge of patches: 5 cm, and at least this many times the smallest length that is resolved.
constexpr double patch_edge = 0.05, cells_per_patch = 4;

/// Time over which recent forces are averaged, s.
constexpr double recent_time = 0.1;

}  // namespace

ObstacleForces::ObstacleForces(const std::vector<Obstacle>& obstacles, int dimension,
                               double resolution)
    : pressures_(dimension, std::max(patch_edge, cells_per_patch * resolution)) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::string& given = obstacles[i].name;
    const std::string name = given.empty() ? "obstacle " + std::to_string(i + 1) : given;
    const auto known = std::find(names_.begin(), names_.end(), name);
    name_of_.push_back(std::size_t(known - names_.begin()));
    if (known == names_.end()) names_.push_back(name);
  }
  forces_.resize(names_.size());
  step_.assign(names_.size(), Vec3::Zero());
  interval_.resize(names_.size());
}

void ObstacleForces::end_step(double time, double dt) noexcept {
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    forces_[i].means.add(step_[i], time, dt);
    step_[i].setZero();
  }
}

void ObstacleForces::end_interval(double duration, const Vec3& gravity) noexcept {
  received_ += gravity;
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    ObstacleForce& force = forces_[i];
    force.impulse += interval_[i];
    received_ -= interval_[i].total();
    if (duration > 0) {
      force.age = std::min(force.age + duration, recent_time);
      const double share = std::min(duration / force.age, 1.0);
      force.recent = (1 - share) * force.recent;
      force.recent.add(interval_[i], share / duration);
    }
    interval_[i] = {};
  }
}

void ObstacleForces::begin_event(double time) noexcept {
  for (ObstacleForce& force : forces_) force.means.begin_event(time);
  pressures_.begin_event(time);
}

void ObstacleForces::begin_balance(const Momentum& now) noexcept {
  mass_ = now.mass;
  momentum_ = now.momentum;
  received_.setZero();
}

Vec3 ObstacleForces::end_balance(const Momentum& now) noexcept {
  const Vec3 left = now.momentum - momentum_ - received_;
  begin_balance(now);
  return left;
}

std::vector<ForceSample> ObstacleForces::sample(double duration) {
  std::vector<ForceSample> samples;
  for (const ObstacleForce& force : forces_) samples.push_back({force.impulse, {}});
  pressures_.sample(duration, [&](const Patch& patch, double pressure) {
    samples[name_of(patch.obstacle())].pressed.add(patch, pressure);
  });
  return samples;
}

template <class Archive, class Self>
void ObstacleForces::visit(Archive& archive, Self& self) {
  archive.packed("forces/obstacles", self.forces_, self.names_.size(),
                 [](auto& force, const auto& number) {
                   ContactImpulse::for_each_number(force.impulse, number);
                   ContactImpulse::for_each_number(force.recent, number);
                   number(force.age);
                   RunningMeans::for_each_number(force.means, number);
                 });
  auto &p = self.momentum_, &r = self.received_, &u = self.unbalanced_;
  archive.numbers("forces/balance", self.mass_, p[0], p[1], p[2], r[0], r[1], r[2], u[0], u[1],
                  u[2]);
}

void ObstacleForces::save(io::BinaryWriter& out) const {
  StateWriter archive(out);
  visit(archive, *this);
  pressures_.save(out);
}

void ObstacleForces::load(const io::BinaryReader& in) {
  const StateReader archive(in);
  visit(archive, *this);
  for (const ObstacleForce& force : forces_)
    if (!force.means.is_sound()) archive.refuse("the mean of a force is not sound");
  pressures_.load(in, name_of_.size());
}

}  // namespace snowshed::methods
