#include "snowshed/run/external_record.hpp"

#include <utility>

#include "snowshed/run/event_sequence.hpp"

namespace snowshed::run {

void ExternalRecord::add_note(const std::string& note) { sequence_.record_.add_note(note); }

void ExternalRecord::describe_machine(std::map<std::string, std::string> facts) {
  sequence_.record_.machine = std::move(facts);
}

void ExternalRecord::set_ageing(const std::string& settings) {
  sequence_.record_.ageing = settings;
}

void ExternalRecord::set_finished_work(std::int64_t steps, double wall) {
  sequence_.set_finished_work(steps, wall);
}

void ExternalRecord::set_tables(RunRecord::Tables tables) {
  sequence_.record_.tables = std::move(tables);
}

void ExternalRecord::set_files(RunRecord::Files files) {
  sequence_.record_.files = std::move(files);
}

void ExternalRecord::drop_files() {
  sequence_.record_.check_files(sequence_.folder_.path());
  if (!sequence_.is_done()) sequence_.record_.files.clear();
}

void ExternalRecord::rewrite() {
  if (sequence_.status_)
    sequence_.record_.write(sequence_.folder_.record(), *sequence_.sim_, *sequence_.status_);
}

}  // namespace snowshed::run
