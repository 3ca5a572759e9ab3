// Saving and restoring a simulation: its scene, where it stands between events, and the solver.
#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/run/snapshot_series.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

/// A number that is another one for other bytes, but for rare accidents (FNV-1a, 64 bits).
class Fingerprint {
 public:
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); ++i)
      value_ = (value_ ^ bytes[i]) * 1099511628211ull;
  }
  void add(const HeightField& f) {
    const double place[] = {f.cell, f.west, f.south, double(f.columns), double(f.rows)};
    add(place, std::size(place));
    add(f.heights.data(), f.heights.size());
  }
  std::int64_t value() const { return std::int64_t(value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

/// Of the files that a slide's terrain and thickness are read from, which a scene only names.
std::vector<std::int64_t> ground_of(const Surroundings& surroundings) {
  Fingerprint terrain, thickness;
  terrain.add(surroundings.terrain);
  if (!surroundings.areas.release.empty() && surroundings.areas.release.front().map)
    thickness.add(*surroundings.areas.release.front().map);
  return {terrain.value(), thickness.value()};
}

void check_ground(const BinaryReader& in, const TerrainSpec& terrain,
                  const Surroundings& surroundings) {
  const auto then = in.get<std::int64_t>("ground", 2);
  const auto now = ground_of(surroundings);
  for (const int i : {0, 1})
    if (then[i] != now[i])
      throw InputError(i == 0 ? terrain.file : terrain.thickness_file,
                       "has changed since the checkpoint " + in.path().string() +
                           " was made; bring back the file, or start anew");
}

}  // namespace

void Simulation::save(const std::filesystem::path& checkpoint) const {
  BinaryWriter out;
  out.add_text("scene", scene_text_);
  out.add_text("base_dir", std::filesystem::absolute(base_dir_).string());
  if (scene_.terrain) out.add("ground", ground_of(surroundings_));
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

/// Throws InputError where `load` would. Particles are there twice meanwhile; where that does not
/// fit into memory, only the file is checked.
void Simulation::read_back(const std::filesystem::path& checkpoint) const {
  const BinaryReader in = BinaryReader::load(checkpoint);
  in.require_finite();
  if (solver_->bytes() < available_memory_bytes()) solver_->check(in);
}

std::unique_ptr<Simulation> Simulation::load(const std::filesystem::path& checkpoint) {
  const BinaryReader in = BinaryReader::load(checkpoint);
  in.require_finite();  // a clock that is not a number would never reach the end of an event
  auto sim = std::make_unique<Simulation>(parse_scene(in.text("scene"), checkpoint.string()),
                                          in.text("base_dir"));
  if (sim->scene_.terrain) check_ground(in, *sim->scene_.terrain, sim->surroundings_);
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
