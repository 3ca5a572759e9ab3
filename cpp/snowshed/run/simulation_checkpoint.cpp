// Saving and restoring a simulation: its scene, its progress through the events, and the method.
#include "snowshed/core/errors.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/io/binary_archive.hpp"
#include "snowshed/methods/capabilities.hpp"
#include "snowshed/run/energy_history.hpp"
#include "snowshed/run/force_history.hpp"
#include "snowshed/run/shape_fingerprints.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/run/snapshot_series.hpp"
#include "snowshed/scene/distinct_snows.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

void check_file(const io::BinaryReader& in, const std::string& file, std::int64_t then,
                std::int64_t now) {
  if (then == now) return;
  if (file.empty())
    throw InputError(in.path().string(), "holds the mark of a file that its scene does not name");
  throw InputError(file, "has changed since the checkpoint " + in.path().string() +
                             " was made; restore the file, or start a new run");
}

/// Throws InputError if a file that the method read has changed since the checkpoint was made.
void check_files(const io::BinaryReader& in, const methods::Surroundings& surroundings) {
  if (!surroundings.input) return;
  const std::vector<methods::FileFingerprint> now = surroundings.input->files();
  const auto then = in.get<std::int64_t>(surroundings.input->section(), now.size());
  for (std::size_t i = 0; i < now.size(); ++i)
    check_file(in, now[i].file, then[i], now[i].fingerprint);
}

std::vector<std::int64_t> fingerprints_of(const methods::MethodInput& input) {
  std::vector<std::int64_t> fingerprints;
  for (const methods::FileFingerprint& file : input.files())
    fingerprints.push_back(file.fingerprint);
  return fingerprints;
}

/// The same for the files that shapes are read from; a checkpoint of an earlier version has no
/// fingerprints of them.
void check_shape_files(const io::BinaryReader& in, const scene::Scene& scene,
                       const std::vector<std::int64_t>& now) {
  const std::vector<std::string> files = scene::shape_files(scene);
  if (files.empty() || !in.has("shape_files")) return;
  const auto then = in.get<std::int64_t>("shape_files", files.size());
  for (std::size_t i = 0; i < files.size(); ++i) check_file(in, files[i], then[i], now[i]);
}

/// The kinds of devices, for checkpoints.
const char* kind_of(const methods::DeviceChoice& device) {
  return device.is_card() ? "gpu" : "cpu";
}

/// Returns a note if the checkpoint was made on a device of another kind; otherwise an empty text.
std::string note_on_device(const io::BinaryReader& in, const methods::DeviceChoice& device) {
  const std::string then = in.has("device") ? in.text("device") : "cpu", now = kind_of(device);
  if (then == now) return "";
  return "the checkpoint was made on a " + then + ", and the run continues on a " + now +
         ": to rounding, not to the same bits";
}

/// Other kernels round differently, so that the run would not continue to the same bits. (Those of
/// cards are not of an instruction set.)
void check_kernels(const io::BinaryReader& in, const methods::DeviceChoice& device) {
  if (!in.has("kernels") || device.is_card()) return;
  if (in.has("device") && in.text("device") != kind_of(device)) return;
  const std::string then = in.text("kernels"), now = kernel_variant_name();
  if (then != now)
    throw InputError(in.path().string(),
                     "made with the kernels " + quote(then) + ", and " + quote(now) +
                         " are used now; set SNOWSHED_KERNELS to " +
                         "those where the machine has them, or start a new run");
}

/// Throws InputError unless the laws of the user are those with which the checkpoint was made.
void check_laws(const io::BinaryReader& in, const methods::UserLaws& laws) {
  const std::string then = in.has("laws") ? in.text("laws") : "";
  if (then == (laws.any() ? laws.name : "")) {
    const std::string numbers = in.has("own_numbers") ? in.text("own_numbers") : "0";
    if (numbers == std::to_string(laws.own_numbers)) return;
    throw InputError(in.path().string(), "made with " + quote(then) + " that has " + numbers +
                                             " numbers of its own for each particle, and not " +
                                             std::to_string(laws.own_numbers));
  }
  throw InputError(in.path().string(),
                   then.empty() ? "made without laws of the user; leave them out"
                                : "made with the laws of the user " + quote(then) +
                                      ", which a checkpoint cannot hold; give them again");
}

/// Says that the functions of the laws differ from those of the checkpoint, or may; else empty.
std::string note_on_laws(const io::BinaryReader& in, const methods::UserLaws& laws) {
  if (!laws.any()) return "";
  const std::string then = in.has("laws_digest") ? in.text("laws_digest") : "";
  if (then.empty() || laws.digest.empty())
    return "laws of the user: " + laws.name +
           "; known by this name only, so they may differ from those of " + in.path().string();
  if (then == laws.digest) return "";
  return "laws of the user: " + laws.name + "; their code has changed since " + in.path().string() +
         " was made";
}

/// Throws InputError unless the particles' snows have the same numbers in another scene.
void check_same_snow(const io::BinaryReader& in, const std::vector<material::Snow>& then,
                     const std::vector<material::Snow>& now) {
  for (std::size_t i = 0; i < then.size(); ++i)
    if (i >= now.size() || scene::material_id_of(then[i], now) != int(i))
      throw InputError(in.path().string(),
                       "the scene does not name its snows first, in the same order");
}

}  // namespace

void Simulation::save(const std::filesystem::path& checkpoint) const {
  io::BinaryWriter out;
  out.add_text("scene", scene_text_);
  out.add_text("base_dir", std::filesystem::absolute(base_dir_).string());
  out.add_text("kernels", kernel_variant_name());
  out.add_text("device", kind_of(device()));
  if (surroundings_.laws.any()) out.add_text("laws", surroundings_.laws.name);
  if (!surroundings_.laws.digest.empty()) out.add_text("laws_digest", surroundings_.laws.digest);
  if (surroundings_.laws.own_numbers)
    out.add_text("own_numbers", std::to_string(surroundings_.laws.own_numbers));
  if (!shape_fingerprints_.empty()) out.add("shape_files", shape_fingerprints_);
  if (surroundings_.input)
    out.add(surroundings_.input->section(), fingerprints_of(*surroundings_.input));
  if (curve_) curve_->save(out);
  if (energies_) energies_->save(out);
  if (forces_) forces_->save(out);
  if (const auto film = film_mark())
    out.add("film", std::vector<std::uint64_t>{film->frames, film->checksum});
  out.add("event", std::vector<std::int64_t>{event_, running_});
  const RestDetector::State r = rest_.state();
  out.add("run", std::vector<double>{event_start_, event_mass_, r.since, r.speed_at_start, r.speed,
                                     r.next, laid_height_});
  method_->save(out);
  try {
    out.save(checkpoint, [this](const std::filesystem::path& written) { read_back(written); });
  } catch (const InputError& error) {
    throw SimulationError(checkpoint.string() + ": not replaced, as the present state cannot be " +
                          "resumed from: " + error.what());
  }
}

/// Makes the checks of `load`, and throws as `load` does. This needs memory for the particles
/// twice; if that is not available, only the file is checked.
void Simulation::read_back(const std::filesystem::path& checkpoint) const {
  const io::BinaryReader in = io::BinaryReader::load(checkpoint);
  in.require_finite();
  if (method_->bytes() < available_memory_bytes()) method_->check(in);
}

std::unique_ptr<Simulation> Simulation::load(const std::filesystem::path& checkpoint,
                                             const scene::Scene* machine,
                                             const methods::UserLaws& laws) {
  const io::BinaryReader in = io::BinaryReader::load(checkpoint);
  in.require_finite();  // a clock that is not a number would never reach the end of an event
  const scene::Scene scene = scene::parse_scene(in.text("scene"), checkpoint.string());
  return from_archive(in, machine ? scene::with_machine_of(*machine, scene) : scene,
                      in.text("base_dir"), laws);
}

std::unique_ptr<Simulation> Simulation::load_into(const scene::Scene& scene,
                                                  const std::filesystem::path& base_dir,
                                                  const std::filesystem::path& checkpoint) {
  const io::BinaryReader in = io::BinaryReader::load(checkpoint);
  in.require_finite();
  const scene::Scene earlier =
      scene::resolve(scene::parse_scene(in.text("scene"), checkpoint.string()));
  check_same_snow(in, scene::distinct_snows(earlier), scene::distinct_snows(scene::resolve(scene)));
  auto sim = from_archive(in, scene, base_dir);
  if (sim->running_)
    throw InputError(checkpoint.string(),
                     "its event " + std::to_string(sim->event_) + " still runs; finish it first");
  return sim;
}

std::unique_ptr<Simulation> Simulation::from_archive(const io::BinaryReader& in,
                                                     const scene::Scene& scene,
                                                     const std::filesystem::path& base_dir,
                                                     const methods::UserLaws& laws) {
  check_laws(in, laws);
  auto sim = std::make_unique<Simulation>(scene, base_dir, laws);
  check_kernels(in, sim->device());
  if (const std::string note = note_on_device(in, sim->device()); !note.empty())
    sim->notes_.push_back(note);
  if (const std::string note = note_on_laws(in, laws); !note.empty()) sim->notes_.push_back(note);
  check_files(in, sim->surroundings_);
  check_shape_files(in, sim->scene_, sim->shape_fingerprints_);
  const auto event = in.get<std::int64_t>("event", 2);
  if (event[0] < 0 || event[0] > sim->scene_.events.count)
    throw InputError(in.path().string(), "event " + std::to_string(event[0]) + " of " +
                                             std::to_string(sim->scene_.events.count));
  sim->event_ = int(event[0]);
  sim->running_ = event[1] != 0;
  const auto run = in.get<double>("run", 7);
  sim->event_start_ = run[0];
  sim->event_mass_ = run[1];
  sim->rest_.restore({run[2], run[3], run[4], run[5]});
  sim->laid_height_ = run[6];
  if (sim->curve_) sim->curve_->load(in);
  if (sim->energies_) sim->energies_->load(in);
  if (sim->forces_) sim->forces_->load(in);
  if (in.has("film")) {
    const auto film = in.get<std::uint64_t>("film", 2);
    sim->film_mark_ = io::FilmMark{std::size_t(film[0]), std::uint32_t(film[1])};
  }
  sim->method_->load(in);
  return sim;
}

}  // namespace snowshed::run
