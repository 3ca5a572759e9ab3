// The block's motion: down the plane at a constant acceleration, unless friction holds it.
#pragma once

#include <algorithm>
#include <cmath>

#include "methods/block/settings.hpp"
#include "snowshed/core/angles.hpp"
#include "snowshed/methods/archive.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/methods/field_sources.hpp"
#include "snowshed/methods/particle_method.hpp"

namespace snowshed::methods::block {

struct Model {
  Settings settings;
  double gravity;  // m/s2, along -z

  Vec3 downward() const {
    const double tilt = radians(settings.tilt);
    return {std::cos(tilt), 0, -std::sin(tilt)};
  }
  double normal_acceleration() const { return gravity * std::cos(radians(settings.tilt)); }
  double acceleration() const {
    return std::max(0.0, gravity * std::sin(radians(settings.tilt)) -
                             settings.friction * normal_acceleration());
  }
};

struct State {
  AlignedVector<Vec3> position, velocity;  // m, m/s
  AlignedVector<double> mass;              // kg
  AlignedVector<std::uint32_t> id;
  AlignedVector<std::uint16_t> event;
  double time = 0, heat = 0;  // s, J
  std::uint32_t next_id = 0;
  StepCounters counters;

  /// Calls visit(name, array) for each array.
  template <class Self, class Visit>
  static void for_each_array(Self& s, const Visit& visit) {
    visit("position", s.position);
    visit("velocity", s.velocity);
    visit("mass", s.mass);
    visit("id", s.id);
    visit("event", s.event);
  }
};

class Solver final : public Method, public SeedsItself, public KeepsEnergy {
 public:
  explicit Solver(const Model& model) : model_(model) {}

  using Method::add;
  void add(const std::vector<ParticleBatch>& batches, const StopRequest&) override {
    State next = state_;
    append(batches, next);
    accept(std::move(next));
  }
  void replace(const std::vector<ParticleBatch>& batches) override {
    State next = state_;
    State::for_each_array(next, [](const char*, auto& array) { array.clear(); });
    append(batches, next);
    accept(std::move(next));
  }
  void add_velocity(const std::vector<Vec3>& changes) override {
    check_velocity_changes(changes, size());
    for (std::size_t k = 0; k < size(); ++k) state_.velocity[order_by_id()[k]] += changes[k];
  }
  std::vector<ParticleBatch> seed(const StopRequest&) const override {
    ParticleBatch batch;
    batch.positions = {Vec3::Zero()};
    batch.mass = model_.settings.mass;
    return {batch};
  }

  void step() override {
    if (size() == 0) throw SimulationError("there is no block");
    const double dt = time_step();
    const Vec3 change = dt * model_.acceleration() * model_.downward();
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec3 moved = dt * (state_.velocity[i] + 0.5 * change);
      state_.position[i] += moved;
      state_.velocity[i] += change;
      state_.heat +=
          model_.settings.friction * state_.mass[i] * model_.normal_acceleration() * moved.norm();
    }
    state_.time += dt;
    ++state_.counters.steps;
    state_.counters.particle_updates += std::int64_t(size());
  }
  bool at_safe_point() const override { return true; }
  double time() const override { return state_.time; }
  double time_step() const override { return model_.settings.time_step; }
  const StepCounters& counters() const override { return state_.counters; }

  std::vector<particles::FieldInfo> fields() const override {
    return list_fields([this](const auto& visit) { visit_fields(visit); });
  }
  particles::FieldView field(const std::string& name) const override {
    return find_field(name, [this](const auto& visit) { visit_fields(visit); });
  }
  const std::vector<std::uint32_t>& order_by_id() const override { return order_.of(state_.id); }

  std::size_t size() const override { return state_.id.size(); }
  ParticleState state() const override {
    ParticleState s;
    for (const std::uint32_t i : order_by_id()) {
      s.positions.push_back(state_.position[i]);
      s.velocities.push_back(state_.velocity[i]);
      s.masses.push_back(state_.mass[i]);
      s.densities.push_back(0);
      s.ids.push_back(state_.id[i]);
      s.events.push_back(state_.event[i]);
    }
    return s;
  }
  MotionSummary motion(double speed) const override {
    return motion_of(
        size(), speed, [this](std::size_t i) { return state_.mass[i]; },
        [this](std::size_t i) { return state_.velocity[i].squaredNorm(); });
  }
  NamedEnergies energies() const override {
    double kinetic = 0, potential = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      kinetic += 0.5 * state_.mass[i] * state_.velocity[i].squaredNorm();
      potential += state_.mass[i] * model_.gravity * state_.position[i].z();
    }
    return {{"kinetic_j", kinetic},
            {"potential_j", potential},
            {"friction_j", state_.heat},
            {"residual_j", kinetic + potential + state_.heat}};
  }
  std::size_t bytes() const override {
    return bytes_of(state_.position, state_.velocity, state_.mass, state_.id, state_.event);
  }

  void save(io::BinaryWriter& out) const override {
    StateWriter archive(out);
    visit_state(archive, state_);
  }
  void load(const io::BinaryReader& in) override { accept(read_state(in)); }
  void check(const io::BinaryReader& in) const override { read_state(in); }

 private:
  template <class Archive, class SomeState>
  static void visit_state(Archive& archive, SomeState& s) {
    const std::size_t n = archive.size("particles/mass", s.mass);
    State::for_each_array(s, [&](const char* name, auto& array) {
      archive.array(std::string("particles/") + name, array, n);
    });
    archive.numbers("clock", s.time, s.heat);
    archive.counts("counters", s.counters.steps, s.counters.particle_updates, s.next_id);
  }
  static State read_state(const io::BinaryReader& in) {
    const StateReader archive(in);
    State next;
    visit_state(archive, next);
    return next;
  }
  static void append(const std::vector<ParticleBatch>& batches, State& s) {
    for (const ParticleBatch& batch : batches) {
      check_batch(batch, 1);
      for (std::size_t k = 0; k < batch.positions.size(); ++k) {
        s.position.push_back(batch.positions[k]);
        s.velocity.push_back(batch.velocity);
        s.mass.push_back(batch.mass_of(k));
        s.id.push_back(s.next_id++);
        s.event.push_back(std::uint16_t(batch.event));
      }
    }
  }
  void accept(State next) {
    state_ = std::move(next);
    order_.forget();
  }
  template <class Visit>
  void visit_fields(Visit visit) const {
    const auto of_each = [&](const char* name, const auto& array) {
      const particles::FieldInfo info =
          field_of(quantity(name), particles::FieldType::float64, false);
      visit(info, [&] {
        return computed_view(info,
                             values_of_each(size(), 1, [&](std::size_t i) { return array[i]; }));
      });
    };
    of_each("position", state_.position);
    of_each("velocity", state_.velocity);
    of_each("mass", state_.mass);
    const auto stored = [&](const char* name, const auto& array, particles::FieldType type) {
      const particles::FieldInfo info = field_of(quantity(name), type, true);
      visit(info, [&] { return stored_view(info, array); });
    };
    stored("id", state_.id, particles::FieldType::uint32);
    stored("event", state_.event, particles::FieldType::uint16);
  }

  Model model_;
  State state_;
  IdOrder order_;
};

}  // namespace snowshed::methods::block
