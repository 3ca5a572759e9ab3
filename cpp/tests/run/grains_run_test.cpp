// Loading tests as simulations: their curve, resuming, and files that have changed.
#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/readers/npy_testing.hpp"
#include "io/forged_archive.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/grains/cost.hpp"
#include "snowshed/methods/grains/loading_curve.hpp"
#include "snowshed/methods/grains/solver.hpp"
#include "snowshed/run/simulation.hpp"

namespace snowshed::methods::grains {
namespace {

using geometry_testing::npy_data;
using geometry_testing::npy_file;
using geometry_testing::npy_header;

constexpr int edge = 4;  // voxels

/// Two grains, one on the other, that fill a cube.
std::vector<std::uint8_t> two_grains() {
  std::vector<std::uint8_t> labels(edge * edge * edge, 1);
  std::fill(labels.begin() + edge * edge * edge / 2, labels.end(), 2);
  return labels;
}

class GrainsRun : public io::TemporaryFolder {
 protected:
  void write_labels(const std::vector<std::uint8_t>& labels) const {
    write_plainly(path("labels.npy"),
                  npy_file(1, npy_header("|u1", "(4, 4, 4)"), npy_data(labels)));
  }

  /// A sample that is compressed by a thousandth and unloaded, in about a hundred steps.
  scene::Scene scene() const {
    write_labels(two_grains());
    scene::Scene s;
    Settings settings;
    settings.threads = 1;
    settings.density_scaling = 100;
    s.numerics = settings;
    s.sample.emplace(SampleSpec{path("labels.npy").string(), 1e-4});
    s.loading = {{LoadingKind::compress, 0.02, 1e-3, 0}, {LoadingKind::unload, 0.02, 2e-3, 1}};
    s.gravity = 0;
    s.events.max_time = 1;
    return s;
  }
};

const Solver& grains_of(const run::Simulation& sim) {
  return dynamic_cast<const Solver&>(sim.method());
}

const auto never_stop = [](const run::RunReport&) { return true; };

std::vector<double> column(const run::Simulation& sim, const std::string& name) {
  const methods::Curve& curve = *sim.curve();
  const auto& names = curve.columns();
  const auto index = std::find(names.begin(), names.end(), name) - names.begin();
  std::vector<double> values;
  for (std::size_t i = std::size_t(index); i < curve.values().size(); i += names.size())
    values.push_back(curve.values()[i]);
  return values;
}

TEST_F(GrainsRun, TheCurveBeginsAtRestAndEndsWithEachStage) {
  run::Simulation sim(scene());
  sim.begin_event();
  EXPECT_EQ(sim.run(never_stop, 1.0), run::RunEnd::rest);
  const auto time = column(sim, "time_s"), stage = column(sim, "stage");
  const auto strain = column(sim, "axial_strain");
  EXPECT_EQ(time.front(), 0);
  EXPECT_NEAR(strain.front(), 0, 1e-12);
  EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
  EXPECT_TRUE(std::is_sorted(stage.begin(), stage.end()));
  const auto second = std::find(stage.begin(), stage.end(), 2.0) - stage.begin();
  ASSERT_LT(std::size_t(second), stage.size());
  EXPECT_NEAR(strain[std::size_t(second) - 1], 1e-3, 2e-5);  // at most a step too far
  EXPECT_EQ(time.back(), sim.method().time());
}

TEST_F(GrainsRun, AResumedRunHasTheSameBitsAndCurve) {
  run::Simulation reference(scene());
  reference.begin_event();
  reference.run(never_stop, 1.0);

  run::Simulation first(scene());
  first.begin_event();
  const auto steps = reference.method().counters().steps;
  ASSERT_GT(steps, 20);
  first.run([&](const run::RunReport& r) { return r.steps < steps / 2; }, 0.0);
  first.save(path("checkpoint"));
  const auto second = run::Simulation::load(path("checkpoint"));
  EXPECT_EQ(second->run(never_stop, 1.0), run::RunEnd::rest);
  EXPECT_EQ(second->curve()->values(), reference.curve()->values());
  EXPECT_TRUE(second->method().state().positions == reference.method().state().positions);
  EXPECT_TRUE(second->method().state().velocities == reference.method().state().velocities);
}

double plate_stress(const LoadingStresses& s) { return std::min(s.top_stress, s.bottom_stress); }

TEST_F(GrainsRun, PeaksCoverAllStepsBetweenTwoRows) {
  scene::Scene s = scene();
  s.loading.resize(1);
  Settings settings;  // some thousand steps
  settings.threads = 1;
  s.numerics = settings;
  run::Simulation sim(s);
  sim.begin_event();
  // Largest stress by row, over the steps.
  std::vector<double> peaks{plate_stress(grains_of(sim).stresses())};
  std::size_t rows = 1;
  while (!*sim.method().at_rest()) {
    if (peaks.size() == rows) peaks.push_back(-1e300);
    sim.step();
    peaks.back() = std::max(peaks.back(), plate_stress(grains_of(sim).stresses()));
    rows = column(sim, "time_s").size();
  }
  const auto top = column(sim, "peak_top_stress_pa"), bottom = column(sim, "peak_bottom_stress_pa");
  ASSERT_EQ(top.size(), peaks.size());
  for (std::size_t row = 0; row < top.size(); ++row)
    EXPECT_EQ(std::min(top[row], bottom[row]), peaks[row]) << row;
  EXPECT_EQ(top[0], column(sim, "top_stress_pa")[0]);
  EXPECT_LT(2 * top.size(), std::size_t(sim.method().counters().steps));
  EXPECT_NE(top, column(sim, "top_stress_pa"));  // some steps carry more than the rows around them
}

TEST_F(GrainsRun, OldCurvesWithoutPeaksAreTheirOwnPeaks) {
  const std::vector<LoadingStage> stages = {{LoadingKind::compress, 0.02, 1e-3, 0}};
  const NamedEnergies energies = {{"kinetic_j", 0.0}};
  constexpr std::size_t measured = 15;
  std::vector<double> values;
  for (int row = 0; row < 3; ++row)
    for (std::size_t c = 0; c < measured + energies.size(); ++c)
      values.push_back(100 * row + double(c));
  io::BinaryWriter out;
  out.add("curve/values", values);
  out.add("curve/stage", std::vector<std::int64_t>{0, 7});
  out.add("curve/begun", std::vector<double>{0.0});
  out.save(path("old"));
  LoadingCurve curve(stages, 1e-3, energies);
  curve.load(io::BinaryReader::load(path("old")));
  const auto& names = curve.columns();
  ASSERT_EQ(curve.values().size(), 3 * names.size());
  for (std::size_t row = 0; row < 3; ++row) {
    const double* now = &curve.values()[row * names.size()];
    const double* then = &values[row * (measured + energies.size())];
    EXPECT_TRUE(std::equal(then, then + measured, now));
    EXPECT_EQ(now[names.size() - 1], then[measured]);  // the energy
    for (std::size_t c = measured; c + 1 < names.size(); ++c) {
      const auto own = std::find(names.begin(), names.end(), names[c].substr(5)) - names.begin();
      EXPECT_EQ(now[c], now[own]) << names[c];
    }
  }
}

TEST_F(GrainsRun, ResumingWithAnotherImageIsRefused) {
  run::Simulation sim(scene());
  sim.begin_event();
  sim.save(path("checkpoint"));
  auto labels = two_grains();
  labels[0] = 0;
  write_labels(labels);
  const std::string message =
      io::message_of<InputError>([&] { run::Simulation::load(path("checkpoint")); });
  EXPECT_NE(message.find("labels.npy: has changed since the checkpoint"), std::string::npos)
      << message;
}

TEST_F(GrainsRun, ADamagedCurveIsRefused) {
  run::Simulation sim(scene());
  sim.begin_event();
  sim.save(path("good"));
  const std::string bytes = content(path("good"));
  for (const std::int64_t stage : {std::int64_t(-1), std::int64_t(3), std::int64_t(1) << 40}) {
    const std::size_t data = bytes.find("curve/stage") + 16;  // the name fills two words
    write_plainly(path("forged"), io::forged(bytes, data, stage));
    const std::string message =
        io::message_of<InputError>([&] { run::Simulation::load(path("forged")); });
    EXPECT_NE(message.find("not that of this loading"), std::string::npos) << message;
  }
}

TEST_F(GrainsRun, VoxelsInAnotherUnitAreRefused) {
  for (const double voxel : {0.1, 1e-7}) {
    scene::Scene s = scene();
    s.sample->voxel_size = voxel;
    const std::string message = io::message_of<InputError>([&] { run::Simulation sim(s); });
    EXPECT_NE(message.find("labels.npy: wrongly scaled"), std::string::npos) << message;
  }
}

TEST_F(GrainsRun, ScatteredLabelsAreNotedOrSplit) {
  scene::Scene s = scene();
  auto labels = two_grains();
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = i / 16 % 2 == 0 ? 1 : 2;  // layers
  write_labels(labels);
  run::Simulation unsplit(s);
  unsplit.begin_event();
  EXPECT_EQ(unsplit.method().size(), 2u);
  EXPECT_NE(unsplit.input_note().find("2 of 2 labels lie in several places, 4 pieces"),
            std::string::npos);
  s.sample->split_labels = true;
  run::Simulation split(s);
  split.begin_event();
  EXPECT_EQ(split.method().size(), 4u);
}

TEST_F(GrainsRun, SparseFilesWithTooManyLabelsAreRefused) {
  const scene::Scene s = scene();
  for (const auto& [shape, size] : {std::pair("(600, 600, 600)", std::uintmax_t(216000000)),
                                    std::pair("(900, 900, 900)", std::uintmax_t(729000000))}) {
    write_plainly(path("labels.npy"), npy_file(1, npy_header("|u1", shape), ""));
    const auto head = std::filesystem::file_size(path("labels.npy"));
    std::filesystem::resize_file(path("labels.npy"), head + size);
    const std::string message = io::message_of<InputError>([&] { run::Simulation sim(s); });
    EXPECT_NE(message.find("labels"), std::string::npos) << message;
    EXPECT_EQ(message.find("no grain"), std::string::npos) << message;
  }
}

TEST_F(GrainsRun, AnImageWithoutGrainsIsRefused) {
  const scene::Scene s = scene();
  write_labels(std::vector<std::uint8_t>(edge * edge * edge, 0));
  const std::string message = io::message_of<InputError>([&] { run::Simulation sim(s); });
  EXPECT_NE(message.find("labels.npy: no grain in the image"), std::string::npos) << message;
}

TEST_F(GrainsRun, StagesBeyondTheTimeLimitAreRefused) {
  scene::Scene s = scene();  // 4e-4 m high, moved by 0.001 and 0.002 of this at 0.02 m/s
  s.events.max_time = 6.1e-5;
  s.events.rest_time = 0;
  EXPECT_NO_THROW(run::Simulation{s});
  s.events.max_time = 5.9e-5;
  const std::string message = io::message_of<InputError>([&] { run::Simulation sim(s); });
  EXPECT_EQ(message.find("/events/max_time: the stages take 6e-05 s"), 0u) << message;
}

TEST_F(GrainsRun, OnlyGrainsHaveACurve) {
  scene::Scene s;
  s.ground.emplace();
  s.bodies.emplace_back().shape.type = "sphere";
  s.bodies.back().shape.radius = 0.1;
  s.bodies.back().shape.center = {0, 0, 0.2};
  EXPECT_EQ(run::Simulation(s).curve(), nullptr);
}

TEST(LoadingProgress, IsTheStrainWeightedByTime) {
  const std::vector<LoadingStage> stages = {{LoadingKind::compress, 0.1, 0.3, 0},
                                            {LoadingKind::hold, 0.1, 0.3, 0},
                                            {LoadingKind::shear, 0.2, 0.2, 0}};
  EXPECT_DOUBLE_EQ(loading_time(stages, 0.01), 0.01 * (3 + 1));
  EXPECT_DOUBLE_EQ(loading_progress(stages, 0, 0.15), 1.5 / 4);
  EXPECT_DOUBLE_EQ(loading_progress(stages, 1, 0.15), 3.0 / 4);
  EXPECT_DOUBLE_EQ(loading_progress(stages, 2, 0.1), 3.5 / 4);
  EXPECT_DOUBLE_EQ(loading_progress(stages, 3, 0.1), 1.0);
}

}  // namespace
}  // namespace snowshed::methods::grains
