// Saving and restoring a simulation: its scene, where it stands between events, and the solver.
#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/run/loading_curve.hpp"
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
  void add(const GrainSample& s) {
    add(s.box.data(), 3);
    add(&s.radius, 1);
    for (const Clump& c : s.clumps) {
      add(c.centre.data(), 3);
      add(&c.volume, 1);
      add(&c.spheres, 1);
    }
    for (const Vec3& x : s.spheres) add(x.data(), 3);
    for (const BondedPair& b : s.bonds) {
      add(&b.first, 1);
      add(&b.second, 1);
    }
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

/// Of the file of grains.
std::int64_t sample_of(const Surroundings& surroundings) {
  Fingerprint sample;
  sample.add(surroundings.sample);
  return sample.value();
}

void check_file(const BinaryReader& in, const std::string& file, std::int64_t then,
                std::int64_t now) {
  if (then != now)
    throw InputError(file, "has changed since the checkpoint " + in.path().string() +
                               " was made; bring back the file, or start anew");
}

/// Throws InputError where a file is another than when the checkpoint was made.
void check_files(const BinaryReader& in, const Scene& scene, const Surroundings& surroundings) {
  if (scene.terrain) {
    const auto then = in.get<std::int64_t>("ground", 2);
    const auto now = ground_of(surroundings);
    check_file(in, scene.terrain->file, then[0], now[0]);
    check_file(in, scene.terrain->thickness_file, then[1], now[1]);
  }
  if (scene.sample)
    check_file(in, scene.sample->file, in.value<std::int64_t>("sample"), sample_of(surroundings));
}

}  // namespace

void Simulation::save(const std::filesystem::path& checkpoint) const {
  BinaryWriter out;
  out.add_text("scene", scene_text_);
  out.add_text("base_dir", std::filesystem::absolute(base_dir_).string());
  if (scene_.terrain) out.add("ground", ground_of(surroundings_));
  if (scene_.sample) out.add_value("sample", sample_of(surroundings_));
  if (curve_) curve_->save(out);
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
  check_files(in, sim->scene_, sim->surroundings_);
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
  if (sim->curve_) sim->curve_->load(in);
  sim->solver_->load(in);
  return sim;
}

}  // namespace snowshed
