// Additions of another program to a run: its files in the results folder, and its entries in
// run.json. The Python package adds tables, pictures and notes.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "snowshed/run/run_record.hpp"

namespace snowshed::run {

class EventSequence;

/// Access of such a program to the record of a sequence, which must outlive it. Changes are written
/// to run.json with the next checkpoint.
class ExternalRecord {
 public:
  explicit ExternalRecord(EventSequence& sequence) : sequence_(sequence) {}

  /// Adds a note for readers of the results, a sentence, unless run.json has it.
  void add_note(const std::string& note);
  /// Sets further facts about the machine, by key.
  void describe_machine(std::map<std::string, std::string> facts);
  /// Sets the settings with which the stack ages between events, as a JSON object.
  void set_ageing(const std::string& settings);
  /// Sets the number of steps and the wall time (s) of all finished events. Runs of the version
  /// before need this, because their run.json does not list these events.
  void set_finished_work(std::int64_t steps, double wall);
  void set_tables(RunRecord::Tables tables);
  void set_files(RunRecord::Files files);

  /// For programs that do not write these files: checks them (InputError if one was changed), then
  /// drops them from the record unless all events are done.
  void drop_files();

  /// Writes run.json again, with the present progress and all changes.
  void rewrite();

 private:
  EventSequence& sequence_;
};

}  // namespace snowshed::run
