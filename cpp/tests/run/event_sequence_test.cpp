#include "snowshed/run/event_sequence.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/build_id.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

class EventSequenceTest : public io::TemporaryFolder {
 protected:
  /// The status in a folder's run.json.
  static std::string status_in(const std::filesystem::path& folder) {
    return nlohmann::json::parse(content(folder / "run.json"))["status"].get<std::string>();
  }
};

/// Records the calls; stops or throws at a report.
class Witness : public EventObserver {
 public:
  explicit Witness(int stops_at = -1, int throws_at = -1)
      : stops_at_(stops_at), throws_at_(throws_at) {}

  void between_events(Simulation& sim) override { note("between", sim.event()); }
  void event_begun(const Simulation& sim, const std::optional<Reseeding>& reseeding) override {
    note(reseeding ? "reseeded" : "begun", sim.event());
  }
  void progress(const Simulation& sim, const RunReport&) override {
    if (sim.event() == 2 && ++reports_ == throws_at_) throw SimulationError("no further");
  }
  void event_ended(const Simulation&, const EventRecord& record) override {
    note(name_of(record.ended), record.event);
    EXPECT_GT(record.steps, 0);
  }
  bool stop_requested() override { return stops_at_ >= 0 && reports_ >= stops_at_; }

  std::string calls;

 private:
  void note(const std::string& what, int event) {
    calls += what + " " + std::to_string(event) + ", ";
  }
  int stops_at_, throws_at_, reports_ = 0;
};

scene::Scene two_events(methods::Between between = methods::Between::carry) {
  scene::Scene scene = small_scene();
  scene.events.count = 2;
  scene.events.between = between;
  return scene;
}

TEST_F(EventSequenceTest, ReportsEventsInOrder) {
  Witness carried, reseeded;
  EXPECT_TRUE(EventSequence::create(two_events(), ".", path("a")).run(carried, 0));
  EXPECT_EQ(carried.calls, "begun 1, rest 1, between 1, begun 2, rest 2, ");
  EXPECT_TRUE(EventSequence::create(two_events(methods::Between::reseed), ".", path("b"))
                  .run(reseeded, never));
  EXPECT_EQ(reseeded.calls, "begun 1, rest 1, between 1, reseeded 2, rest 2, ");
}

TEST_F(EventSequenceTest, ResumesWhereItWasStopped) {
  Witness undisturbed, first(20), second;
  EventSequence uninterrupted = EventSequence::create(two_events(), ".", path("a"));
  EXPECT_TRUE(uninterrupted.run(undisturbed, 0));
  EXPECT_FALSE(EventSequence::create(two_events(), ".", path("b")).run(first, 0));
  EXPECT_EQ(status_in(path("b")), "interrupted");
  EventSequence resumed = EventSequence::resume(two_events(), ".", path("b"));
  ASSERT_TRUE(resumed.simulation().event_running());
  EXPECT_TRUE(resumed.run(second, 0));
  EXPECT_EQ(status_in(path("b")), "finished");
  expect_same_bits(resumed.simulation(), uninterrupted.simulation());
  ASSERT_EQ(resumed.record().finished_events.size(), 2u);
  for (int i : {0, 1}) {
    const EventRecord &a = resumed.record().finished_events[i],
                      &b = uninterrupted.record().finished_events[i];
    EXPECT_EQ(a.steps, b.steps);
    EXPECT_EQ(a.sim_time, b.sim_time);
    EXPECT_EQ(a.laid_height, b.laid_height);
    EXPECT_EQ(a.energy, b.energy);
  }
}

TEST_F(EventSequenceTest, ResumesToTheSameBitsOnOtherThreads) {
  Witness undisturbed, first(20), second;
  scene::Scene single = two_events(), two = two_events();
  single.numerics.as<methods::mpm::Settings>().threads = 1;
  two.numerics.as<methods::mpm::Settings>().threads = 2;
  EventSequence uninterrupted = EventSequence::create(single, ".", path("a"));
  EXPECT_TRUE(uninterrupted.run(undisturbed, 0));
  EXPECT_FALSE(EventSequence::create(single, ".", path("b")).run(first, 0));
  EventSequence resumed = EventSequence::resume(two, ".", path("b"));
  EXPECT_EQ(resumed.simulation().scene().numerics.as<methods::mpm::Settings>().threads, 2);
  EXPECT_TRUE(resumed.run(second, 0));
  expect_same_bits(resumed.simulation(), uninterrupted.simulation());
  EXPECT_EQ(content(path("a") / "film.bin"), content(path("b") / "film.bin"));
}

TEST_F(EventSequenceTest, ACompleteFilmIsClosed) {
  Witness quiet;
  EventSequence::create(two_events(), ".", path("a")).run(quiet, never);
  EXPECT_TRUE(io::FilmReader(path("a") / "film.bin").closed());
  const std::string before = content(path("a") / "film.bin");
  EventSequence::resume(two_events(), ".", path("a")).run(quiet, never);
  EXPECT_EQ(content(path("a") / "film.bin"), before);
}

TEST_F(EventSequenceTest, RefusesAChangedRecord) {
  Witness quiet;
  EventSequence::create(two_events(), ".", path("a")).run(quiet, never);
  const std::string intact = content(path("a") / "run.json");
  for (std::size_t at = 1; at + 4 < intact.size(); at += 7) {
    std::string bytes = intact;
    bytes[at] = bytes[at] == '7' ? '8' : '7';
    std::ofstream(path("a") / "run.json", std::ios::binary) << bytes;
    EXPECT_THROW(EventSequence::resume(two_events(), ".", path("a")), InputError) << at;
  }
}

TEST_F(EventSequenceTest, EventsAfterTheCheckpointAreRunAgain) {
  Witness first, second;
  EventSequence::create(two_events(), ".", path("a")).run(first, never);
  std::filesystem::remove(path("a") / "checkpoint.bin");
  EventSequence again = EventSequence::resume(two_events(), ".", path("a"));
  EXPECT_TRUE(again.record().finished_events.empty());
  EXPECT_TRUE(again.run(second, never));
  EXPECT_EQ(second.calls, first.calls);
}

TEST_F(EventSequenceTest, AFailureIsRecordedAndTheRunCanBeResumed) {
  Witness failing(-1, 20), second;
  EventSequence sequence = EventSequence::create(two_events(), ".", path("a"));
  EXPECT_THROW(sequence.run(failing, 0), SimulationError);
  sequence.record_failure("no further");
  EXPECT_NE(content(path("a") / "run.json").find("\"error\": \"no further\""), std::string::npos);
  sequence.close();
  EventSequence resumed = EventSequence::resume(two_events(), ".", path("a"));
  EXPECT_GT(resumed.simulation().event_time(), 0);
  EXPECT_TRUE(resumed.run(second, never));
}

/// The state between two events may have aged already, and would age twice when resumed.
TEST_F(EventSequenceTest, AFailureBetweenEventsKeepsTheLastCheckpoint) {
  Witness quiet;
  scene::Scene scene = two_events();
  EventSequence sequence = EventSequence::create(scene, ".", path("a"));
  EXPECT_TRUE(sequence.run(quiet, never));
  const std::string before = content(path("a") / "checkpoint.bin");
  const std::size_t n = sequence.simulation().method().size();
  sequence.simulation().settle(std::vector<double>(n, 0.001), std::vector<double>(n, 0.0));
  sequence.record_failure("no snow");
  EXPECT_TRUE(content(path("a") / "checkpoint.bin") == before);
}

TEST_F(EventSequenceTest, TwoRunsDoNotShareAFolder) {
  EventSequence first = EventSequence::create(two_events(), ".", path("a"));
  EXPECT_THROW(EventSequence::resume(two_events(), ".", path("a")), InputError);
  first.close();
  EXPECT_NO_THROW(EventSequence::resume(two_events(), ".", path("a")));
}

TEST_F(EventSequenceTest, RefusesTheCheckpointOfAnotherScene) {
  Witness quiet;
  scene::Scene steeper = two_events();
  steeper.panel->tilt += 5;
  EventSequence::create(two_events(), ".", path("a")).run(quiet, never);
  EventSequence::create(steeper, ".", path("b")).run(quiet, never);
  std::filesystem::copy_file(path("b") / "checkpoint.bin", path("a") / "checkpoint.bin",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(
      io::message_of<InputError>([&] { EventSequence::resume(two_events(), ".", path("a")); }),
      (path("a") / "checkpoint.bin").string() +
          ": made by another scene, which differs from scene.json in /panel/tilt");
}

TEST_F(EventSequenceTest, ResumesOnlyItsOwnScene) {
  Witness quiet;
  scene::Scene scene = two_events();
  EventSequence::create(scene, ".", path("a")).run(quiet, never);
  scene.panel->tilt = 55;
  scene.gravity = 3;
  const std::string message =
      io::message_of<InputError>([&] { EventSequence::resume(scene, ".", path("a")); });
  EXPECT_NE(message.find("differs in /gravity, /panel/tilt;"), std::string::npos) << message;
  EXPECT_THROW(EventSequence::resume(scene, ".", path("nowhere")), InputError);
}

TEST_F(EventSequenceTest, LeavesNoFilesIfItCannotBegin) {
  scene::Scene scene = two_events();
  scene.bodies.emplace_back().shape.type = "sphere";
  scene.bodies.back().shape.center = {1e6, 0, 0};  // the grid does not reach so far
  EXPECT_THROW(EventSequence::create(scene, ".", path("a")), InputError);
  EXPECT_FALSE(std::filesystem::exists(path("a")));
  write_plainly(path("file"), "");
  EXPECT_THROW(EventSequence::create(two_events(), ".", path("file")), InputError);
}

TEST_F(EventSequenceTest, TheRecordAloneMakesTheSameResults) {
  EventObserver quiet;
  EXPECT_TRUE(EventSequence::create(two_events(), ".", path("a")).run(quiet, never));
  const auto record = nlohmann::json::parse(content(path("a") / "run.json"));
  EXPECT_EQ(record["build"], build_id());
  EXPECT_EQ(record["compiler"], compiler_name());
  const scene::Scene again = scene::load_scene(path("a") / "run.json");
  EXPECT_TRUE(EventSequence::create(again, ".", path("b")).run(quiet, never));
  for (const char* file : {"scene.json", "particles/event_001.vtp", "particles/event_002.vtp"})
    EXPECT_EQ(content(path("a") / file), content(path("b") / file)) << file;
}

TEST_F(EventSequenceTest, FilesOfTheSceneHaveChecksumsInTheRecord) {
  std::ofstream(path("solid.stl")) << "solid s\n"
                                   << "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                   << "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
  scene::Scene scene;
  scene::ObstacleSpec& obstacle = scene.obstacles.emplace_back();
  obstacle.shape.type = "mesh";
  obstacle.shape.file = "solid.stl";
  RunRecord record;
  record.mark_inputs(scene, path(""));
  ASSERT_EQ(record.inputs.count("solid.stl"), 1u);
  EXPECT_EQ(record.inputs["solid.stl"].bytes, std::filesystem::file_size(path("solid.stl")));
  const std::string before = record.inputs["solid.stl"].checksum;
  std::ofstream(path("solid.stl"), std::ios::app) << " ";
  RunRecord later;
  later.mark_inputs(scene, path(""));
  EXPECT_NE(later.inputs["solid.stl"].checksum, before);
}

/// Collects the notes of a run.
class Listener : public EventObserver {
 public:
  explicit Listener(bool stops) : stops_(stops) {}
  void noted(const std::string& note) override { notes += note + "; "; }
  bool stop_requested() override { return stops_; }
  std::string notes;

 private:
  bool stops_;
};

TEST_F(EventSequenceTest, AnotherBuildThatResumesIsNoted) {
  Listener first(true), same(true), other(false);
  EXPECT_FALSE(EventSequence::create(two_events(), ".", path("a")).run(first, 0));
  EXPECT_FALSE(EventSequence::resume(two_events(), ".", path("a")).run(same, 0));
  EXPECT_EQ(same.notes, "");
  auto record = nlohmann::ordered_json::parse(content(path("a") / "run.json"));
  record.erase("checksum");
  record["build"] = "0123456789ab";
  std::ofstream(path("a") / "run.json") << scene::sealed_text(record);
  EXPECT_TRUE(EventSequence::resume(two_events(), ".", path("a")).run(other, never));
  EXPECT_NE(other.notes.find("begun by the build 0123456789ab"), std::string::npos) << other.notes;
}

}  // namespace
}  // namespace snowshed::run
