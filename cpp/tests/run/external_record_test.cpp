#include "snowshed/run/external_record.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/temporary_folder.hpp"
#include "run/simulation_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/run/event_sequence.hpp"

namespace snowshed::run {
namespace {

class ExternalRecordTest : public io::TemporaryFolder {
 protected:
  nlohmann::json record() const {
    return nlohmann::json::parse(content(path("results") / "run.json"));
  }
};

/// Stops a run at its first safe point.
class Stopping : public EventObserver {
 public:
  bool stop_requested() override { return true; }
};

TEST_F(ExternalRecordTest, ChangedFilesAreRefusedAndMissingOnesDropped) {
  Stopping observer;
  EventSequence interrupted = EventSequence::create(small_scene(), ".", path("results"));
  ExternalRecord(interrupted).set_files({{"curve.csv", {5, "a5fe3a3f"}}});
  EXPECT_FALSE(interrupted.run(observer, 0));
  interrupted.close();
  for (const char* text : {"bende", "abcd", "abcdf"}) {
    std::ofstream(path("results") / "curve.csv") << text;
    EventSequence resumed = EventSequence::resume(small_scene(), ".", path("results"));
    EXPECT_THROW(ExternalRecord(resumed).drop_files(), InputError) << text;
  }
  std::filesystem::remove(path("results") / "curve.csv");
  EventSequence resumed = EventSequence::resume(small_scene(), ".", path("results"));
  EXPECT_NO_THROW(ExternalRecord(resumed).drop_files());
  EXPECT_TRUE(resumed.record().files.empty());
}

TEST_F(ExternalRecordTest, FilesOfAFinishedRunStay) {
  EventObserver quiet;
  EventSequence sequence = EventSequence::create(small_scene(), ".", path("results"));
  ExternalRecord(sequence).set_files({{"curve.csv", {5, "a5fe3a3f"}}});
  EXPECT_TRUE(sequence.run(quiet, never));
  ExternalRecord(sequence).drop_files();
  EXPECT_EQ(sequence.record().files.size(), 1u);
}

TEST_F(ExternalRecordTest, ChangesAfterTheRunAreRecorded) {
  EventObserver quiet;
  EventSequence sequence = EventSequence::create(small_scene(), ".", path("results"));
  EXPECT_TRUE(sequence.run(quiet, never));
  const std::size_t notes = sequence.record().notes.size();
  ExternalRecord external(sequence);
  external.add_note("The stack is low.");
  external.add_note("The stack is low.");
  external.describe_machine({{"processor", "of the test"}});
  external.set_tables({{"events.csv", {{"1", "0badcafe"}}}});
  external.rewrite();
  EXPECT_EQ(record()["notes"].back(), "The stack is low.");
  EXPECT_EQ(record()["notes"].size(), notes + 1);
  EXPECT_EQ(record()["processor"], "of the test");
  EXPECT_EQ(record()["tables"]["events.csv"]["1"], "0badcafe");
  EXPECT_EQ(record()["status"], "finished");
}

}  // namespace
}  // namespace snowshed::run
