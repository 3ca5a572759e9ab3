#include "snowshed/methods/grains/loading_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed::methods::grains {
namespace {

/// Columns before those of peaks and energies.
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

/// Calls visit(name, value) for each of the strains and stresses.
template <class Stresses, class Visit>
void for_each_stress(Stresses& s, const Visit& visit) {
  visit("axial_strain", s.axial_strain);
  visit("shear_strain", s.shear_strain);
  visit("top_stress_pa", s.top_stress);
  visit("bottom_stress_pa", s.bottom_stress);
  visit("side_stress_pa", s.side_stress);
  visit("shear_stress_pa", s.shear_stress);
  visit("cone_force_n", s.cone_force);
}
constexpr std::size_t peak_columns = 7;

/// Returns the rows of a checkpoint from a version without peaks in the present form. The peak of a
/// row is the row itself.
std::vector<double> with_peaks(const io::ArrayView<double>& values, std::size_t columns,
                               const std::vector<std::string>& names) {
  std::vector<double> filled;
  filled.reserve(values.size / columns * (columns + peak_columns));
  const std::size_t measured = measured_columns.size();
  const LoadingStresses none;
  for (const double* row = values.begin(); row != values.end(); row += columns) {
    filled.insert(filled.end(), row, row + measured);
    for_each_stress(none, [&](const char* name, double) {
      const auto place = std::find(names.begin(), names.end(), name) - names.begin();
      filled.push_back(row[place]);
    });
    filled.insert(filled.end(), row + measured, row + columns);
  }
  return filled;
}

}  // namespace

LoadingCurve::LoadingCurve(std::vector<LoadingStage> stages, double height,
                           const NamedEnergies& energies)
    : stages_(std::move(stages)),
      height_(height),
      energy_(!energies.empty()),
      columns_(measured_columns) {
  const LoadingStresses none;
  for_each_stress(
      none, [this](const char* name, double) { columns_.push_back(std::string("peak_") + name); });
  for (const auto& energy : energies) columns_.push_back(energy.first);
  // No row is lost later if memory runs out.
  values_.reserve((stages_.size() * (points + 1) + 1) * columns_.size());
}

/// Time at which the present stage reaches its next point. `hold` uses the times at which its speed
/// would reach the strains.
double LoadingCurve::next_time() const {
  const LoadingStage& stage = stages_[std::size_t(stage_)];
  const double part = double(points_done_ + 1) / points;
  return begun_ + part * part * stage.strain * height_ / stage.speed;
}

/// Load on the sample in the stage whose rows are being added. The step that ends a stage belongs
/// to it.
double LoadingCurve::load_on_sample(const LoadingStresses& s) const {
  const std::size_t stage = std::min(std::size_t(stage_), stages_.size() - 1);
  switch (stages_[stage].kind) {
    case LoadingKind::shear:
      return std::abs(s.shear_stress);
    case LoadingKind::penetrate:
      return std::abs(s.cone_force);
    case LoadingKind::stretch:
      return std::min(-s.top_stress, -s.bottom_stress);
    default:
      return std::min(s.top_stress, s.bottom_stress);
  }
}

/// Keeps the strains and stresses of a step if the load is larger than in all steps since the last
/// row.
void LoadingCurve::keep_peak(const LoadingStresses& s) {
  if (!peak_ || load_on_sample(s) > load_on_sample(*peak_)) peak_ = s;
}

void LoadingCurve::record(const Method& method) {
  const auto& grains = dynamic_cast<const Solver&>(method);
  const int stage = grains.stage();
  const double time = grains.time();
  keep_peak(grains.stresses());
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

void LoadingCurve::add_row(const Solver& grains) {
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
  for_each_stress(*peak_, [this](const char*, double value) { values_.push_back(value); });
  peak_.reset();
  if (energy_)
    for (const auto& energy : grains.energies()) values_.push_back(energy.second);
}

void LoadingCurve::save(io::BinaryWriter& out) const {
  out.add("curve/values", values_);
  out.add("curve/stage", std::vector<std::int64_t>{stage_, points_done_});
  out.add("curve/begun", std::vector<double>{begun_});
  std::vector<double> peak;  // empty directly after a row
  if (peak_) for_each_stress(*peak_, [&](const char*, double value) { peak.push_back(value); });
  out.add("curve/peak", std::move(peak));
}

void LoadingCurve::load(const io::BinaryReader& in) {
  const auto values = in.view<double>("curve/values");
  const auto stage = in.get<std::int64_t>("curve/stage", 2);
  const auto stages = std::int64_t(stages_.size());
  const bool has_peaks = in.has("curve/peak");  // earlier versions did not save peaks
  const std::size_t columns = columns_.size() - (has_peaks ? 0 : peak_columns);
  const std::vector<double> peak = has_peaks ? in.get<double>("curve/peak") : std::vector<double>{};
  if (values.size / columns > values_.capacity() / columns_.size() || values.size % columns != 0 ||
      stage[0] < 0 || stage[0] > stages || stage[1] < -1 || stage[1] > points ||
      (!peak.empty() && peak.size() != peak_columns))
    throw InputError(in.path().string(), "the curve is not that of this loading");
  begun_ = in.value<double>("curve/begun");
  if (has_peaks) {
    values_.assign(values.begin(), values.end());
  } else {
    const std::vector<double> filled = with_peaks(values, columns, columns_);
    values_.assign(filled.begin(), filled.end());  // keeps the reserved memory
  }
  peak_.reset();
  if (!peak.empty()) {
    auto next = peak.begin();
    peak_.emplace();
    for_each_stress(*peak_, [&](const char*, double& value) { value = *next++; });
  }
  stage_ = int(stage[0]);
  points_done_ = int(stage[1]);
}

}  // namespace snowshed::methods::grains
