// The solver of grains: its data, and the order of its parts.
#pragma once

#include "snowshed/methods/grains/state.hpp"
#include "snowshed/methods/particle_method.hpp"

namespace snowshed::methods::grains {

class SolverImpl final : public Solver {
 public:
  explicit SolverImpl(Options);

  using Method::add;
  void add(const std::vector<ParticleBatch>&, const StopRequest&) override;
  void replace(const std::vector<ParticleBatch>&) override;
  void add_velocity(const std::vector<Vec3>&) override;

  void step() override;
  bool at_safe_point() const override { return true; }
  std::optional<bool> at_rest() const override {
    return state_.loading.stage >= int(model_.loading.size());
  }
  std::optional<double> progress() const override;
  double time() const override { return state_.time; }
  double time_step() const override { return state_.dt; }
  const StepCounters& counters() const override { return state_.counters; }

  std::vector<particles::FieldInfo> fields() const override;
  particles::FieldView field(const std::string&) const override;
  const std::vector<std::uint32_t>& order_by_id() const override { return order_; }

  std::size_t size() const override { return state_.bodies.size(); }
  ParticleState state() const override;
  MotionSummary motion(double speed) const override;
  NamedEnergies energies() const override;
  PointCloud snapshot() const override;
  std::size_t bytes() const override;

  void save(io::BinaryWriter&) const override;
  void load(const io::BinaryReader&) override;
  void check(const io::BinaryReader&) const override;

  using SeedsItself::seed;
  std::vector<ParticleBatch> seed(const StopRequest&) const override;
  std::unique_ptr<Curve> empty_curve() const override;
  std::size_t count_spheres() const override { return model_.spheres.offsets.size(); }
  std::int64_t pair_searches() const override { return state_.pair_searches; }
  LoadingMeasures measures() const override;
  LoadingStresses stresses() const override;
  int stage() const override { return state_.loading.stage; }
  std::vector<GrainContact> grain_contacts() const override;
  std::vector<Vec3> sphere_positions() const override;
  std::vector<std::uint32_t> sphere_grains() const override { return model_.spheres.grain; }

 private:
  /// Contents of an archive.
  struct LoadedState {
    State state;
    Workspace work;
  };
  LoadedState read_state(const io::BinaryReader&) const;

  State with_batches(const std::vector<ParticleBatch>&) const;
  void accept(State, Workspace);
  double shortened_by() const;
  void require_grains() const;
  void drift(double dt);
  void check_places() const;
  bool must_relist(const Boundary&) const;
  void relist(const Boundary&);
  void end_step(const Boundary& moved, double dt);
  template <class Visit>
  void visit_fields(Visit) const;

  Model model_;
  State state_;
  Workspace workspace_;
  Soundness soundness_;
  std::vector<std::uint32_t> order_;
};

}  // namespace snowshed::methods::grains
