#include "snowshed/run/loading_curve.hpp"

#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed {
namespace {

/// Energies are added behind these.
const std::vector<std::string> measured_columns = {"time_s",
                                                   "stage",
                                                   "axial_strain",
                                                   "shear_strain",
                                                   "top_stress_pa",
                                                   "bottom_stress_pa",
                                                   "side_stress_pa",
                                                   "shear_stress_pa",
                                                   "cone_force_n",
                                                   "bonds",
                                                   "broken_in_tension",
                                                   "broken_in_shear",
                                                   "contacts",
                                                   "coordination",
                                                   "solid_fraction"};

}  // namespace

LoadingCurve::LoadingCurve(std::vector<LoadingStage> stages, double height,
                           const NamedEnergies& energies)
    : stages_(std::move(stages)),
      height_(height),
      energy_(!energies.empty()),
      columns_(measured_columns) {
  for (const auto& energy : energies) columns_.push_back(energy.first);
  // So that no row is lost for lack of memory.
  values_.reserve((stages_.size() * (points + 1) + 1) * columns_.size());
}

/// When the present stage reaches its next point; one that holds has the times of its strain, too.
double LoadingCurve::next_time() const {
  const LoadingStage& stage = stages_[std::size_t(stage_)];
  const double part = double(points_done_ + 1) / points;
  return begun_ + part * part * stage.strain * height_ / stage.speed;
}

void LoadingCurve::record(const GrainsMethod& grains) {
  const int stage = grains.stage();
  const double time = grains.time();
  if (points_done_ < 0) {
    add_row(grains);
    points_done_ = 0;
  } else if (stage != stage_) {
    add_row(grains);  // the end of the stage before
    stage_ = stage;
    begun_ = time;
    points_done_ = 0;
  } else if (std::size_t(stage_) < stages_.size() && points_done_ < points && time >= next_time()) {
    add_row(grains);
    while (points_done_ < points && time >= next_time()) ++points_done_;
  }
}

void LoadingCurve::add_row(const GrainsMethod& grains) {
  const LoadingMeasures m = grains.measures();
  const double row[] = {grains.time(),
                        double(stage_ + 1),
                        m.axial_strain,
                        m.shear_strain,
                        m.top_stress,
                        m.bottom_stress,
                        m.side_stress,
                        m.shear_stress,
                        m.cone_force,
                        double(m.bonds),
                        double(m.broken_in_tension),
                        double(m.broken_in_shear),
                        double(m.contacts),
                        m.coordination,
                        m.solid_fraction};
  values_.insert(values_.end(), std::begin(row), std::end(row));
  if (energy_)
    for (const auto& energy : grains.energy_table()) values_.push_back(energy.second);
}

void LoadingCurve::save(BinaryWriter& out) const {
  out.add("curve/values", values_);
  out.add("curve/stage", std::vector<std::int64_t>{stage_, points_done_});
  out.add("curve/begun", std::vector<double>{begun_});
}

void LoadingCurve::load(const BinaryReader& in) {
  const auto values = in.view<double>("curve/values");
  const auto stage = in.get<std::int64_t>("curve/stage", 2);
  const auto stages = std::int64_t(stages_.size());
  if (values.size > values_.capacity() || values.size % columns_.size() != 0 || stage[0] < 0 ||
      stage[0] > stages || stage[1] < -1 || stage[1] > points)
    throw InputError(in.path().string(), "the curve is not that of this loading");
  begun_ = in.value<double>("curve/begun");
  values_.assign(values.begin(), values.end());
  stage_ = int(stage[0]);
  points_done_ = int(stage[1]);
}

}  // namespace snowshed
