// The slide's solver: its data, and the order of its parts.
#pragma once

#include "snowshed/methods/particle_method.hpp"
#include "snowshed/methods/slide/release.hpp"
#include "snowshed/methods/slide/solver.hpp"

namespace snowshed::methods::slide {

class SolverImpl final : public Solver {
 public:
  explicit SolverImpl(Options);

  using Method::add;
  void add(const std::vector<ParticleBatch>&, const StopRequest&) override;
  void replace(const std::vector<ParticleBatch>&) override;
  void add_velocity(const std::vector<Vec3>&) override;

  void step() override;
  bool at_safe_point() const override { return true; }
  std::optional<bool> at_rest() const override { return state_.stopped; }
  double time() const override { return state_.time; }
  double time_step() const override { return state_.dt; }
  const StepCounters& counters() const override { return state_.counters; }

  std::vector<particles::FieldInfo> fields() const override;
  particles::FieldView field(const std::string&) const override;
  const std::vector<std::uint32_t>& order_by_id() const override {
    return order_.of(state_.particles.id);
  }

  std::size_t size() const override { return state_.particles.size(); }
  ParticleState state() const override;
  MotionSummary motion(double speed) const override;
  NamedEnergies energies() const override;
  PointCloud snapshot() const override;
  Section run_section() const override;
  std::size_t bytes() const override;

  void save(io::BinaryWriter&) const override;
  void load(const io::BinaryReader&) override;
  void check(const io::BinaryReader&) const override;

  using SeedsItself::seed;
  std::vector<ParticleBatch> seed(const StopRequest& stop) const override {
    std::vector<ParticleBatch> batches =
        seed_release(model_.settings, model_.terrain, model_.areas.release, stop);
    for (ParticleBatch& batch : batches) batch.fall_speed = model_.areas.release_speed;
    return batches;
  }
  std::size_t count_seeds() const override {
    std::size_t count = 0;
    for (const ParticleBatch& batch : seed()) count += batch.positions.size();
    for (const LateRelease& late : model_.late) count += late.snow.positions.size();
    return count;
  }
  std::vector<LateReleaseFact> late_releases() const override;
  std::vector<DamFact> dams() const override;
  const ChangingGround* ground() const override {
    return state_.ground ? &*state_.ground : nullptr;
  }
  std::int64_t bonds_in_ground() const override { return state_.bonds_in_ground; }
  const Terrain& terrain() const override { return model_.terrain; }
  const PeakFields& peaks() const override { return state_.peaks; }
  const GridFields& flow() const override { return workspace_.fields; }
  const Bonds& bonds() const override { return state_.bonds; }
  std::int64_t bonds_made() const override { return state_.bonds_made; }
  const MassBalance& mass_balance() const override { return state_.balance; }

 private:
  void append(State&, const ParticleBatch&, const std::vector<Area>* areas,
              const StopRequest&) const;
  void append_all(State&, const std::vector<ParticleBatch>&, const StopRequest&) const;
  void append_due(State&, Trigger) const;
  bool release_before_step();
  void release_in_step();
  void accept(State);
  void sort_if_due();
  void keep_positions();
  void choose_threads();
  void choose_step(State& next, const Workspace& work) const;
  void count_as_added(const State& next, const Workspace& work, EnergyBalance& sums) const;
  template <class Visit>
  void visit_fields(Visit) const;

  Model model_;
  State state_;
  Workspace workspace_;
  Soundness soundness_;
  IdOrder order_;
};

}  // namespace snowshed::methods::slide
