// Measurements of a loading test, as a table that grows while the test runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "snowshed/methods/grains/solver.hpp"

namespace snowshed::methods::grains {

/// Rows of instantaneous values at the beginning of the test, at `points` strains of each stage,
/// and at the end of each stage. The strains are (k / points)^2 of the stage's final strain,
/// because a brittle sample is elastic only up to a thousandth of it. The rows depend on the steps
/// alone, not on the number of threads or on a resumption of the run.
///
/// Each row also has peaks: the strains and stresses of the step with the largest load since the
/// last row. The strength is the largest stress of all steps, not only of those with rows. The load
/// depends on the stage: the smaller stress of the two plates (`compress`, `isotropic`, `unload`,
/// `hold`; in `stretch` the smaller tension), the shear stress, the force on the cone.
class LoadingCurve final : public Curve {
 public:
  static constexpr int points = 300;

  /// A curve for the stages of a sample with this initial height (m), and for the named energies.
  LoadingCurve(std::vector<LoadingStage>, double height, const NamedEnergies& energies);

  void record(const Method& grains) override;

  const std::vector<std::string>& columns() const override { return columns_; }
  const std::vector<double>& values() const override { return values_; }

  void save(io::BinaryWriter&) const override;
  void load(const io::BinaryReader&) override;

 private:
  double next_time() const;
  double load_on_sample(const LoadingStresses&) const;
  void keep_peak(const LoadingStresses&);
  void add_row(const Solver&);

  std::vector<LoadingStage> stages_;
  double height_;
  bool energy_;
  std::vector<std::string> columns_;
  std::vector<double> values_;
  int stage_ = 0;                        // stage that is being loaded
  double begun_ = 0;                     // s, when it began
  int points_done_ = -1;                 // points of the stage; -1 before the beginning of the test
  std::optional<LoadingStresses> peak_;  // peak of the steps since the last row, if there were any
};

}  // namespace snowshed::methods::grains
