// Saving and restoring a simulation: its scene, where it stands between events, and the solver.
#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/run/snapshot_series.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {

void Simulation::save(const std::filesystem::path& checkpoint) const {
  BinaryWriter out;
  out.add_text("scene", scene_text_);
  out.add_text("base_dir", std::filesystem::absolute(base_dir_).string());
  out.add("event", std::vector<std::int64_t>{event_, running_});
  const RestDetector::State r = rest_.state();
  out.add("run", std::vector<double>{event_start_, event_mass_, r.since, r.speed_at_start, r.speed,
                                     r.next, laid_height_});
  solver_->save(out);
  try {
    out.save(checkpoint, [this](const std::filesystem::path& written) { read_back(written); });
  } catch (const InputError& error) {
    throw SimulationError(checkpoint.string() + ": not replaced, as the present state cannot be " +
                          "resumed from: " + error.what());
  }
}

/// Throws InputError where `load` would. Particles and grid are there twice meanwhile; where that
/// does not fit into memory, only the file is checked.
void Simulation::read_back(const std::filesystem::path& checkpoint) const {
  const BinaryReader in = BinaryReader::load(checkpoint);
  in.require_finite();
  if (solver_->bytes() < available_memory_bytes()) empty_method()->load(in);
}

std::unique_ptr<Simulation> Simulation::load(const std::filesystem::path& checkpoint) {
  const BinaryReader in = BinaryReader::load(checkpoint);
  in.require_finite();  // a clock that is not a number would never reach the end of an event
  auto sim = std::make_unique<Simulation>(parse_scene(in.text("scene"), checkpoint.string()),
                                          in.text("base_dir"));
  const auto event = in.get<std::int64_t>("event", 2);
  if (event[0] < 0 || event[0] > sim->scene_.events.count)
    throw InputError(checkpoint.string(), "event " + std::to_string(event[0]) + " of " +
                                              std::to_string(sim->scene_.events.count));
  sim->event_ = int(event[0]);
  sim->running_ = event[1] != 0;
  const auto run = in.get<double>("run", 7);
  sim->event_start_ = run[0];
  sim->event_mass_ = run[1];
  sim->rest_.restore({run[2], run[3], run[4], run[5]});
  sim->laid_height_ = run[6];
  sim->solver_->load(in);
  return sim;
}

}  // namespace snowshed
