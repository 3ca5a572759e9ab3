#include "snowshed/run/program.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/core/version.hpp"
#include "snowshed/io/home_folder.hpp"
#include "snowshed/run/event_sequence.hpp"
#include "snowshed/run/external_record.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {
namespace {

constexpr const char* usage =
    "usage: snowshed-run SCENE.json -o DIR [--resume] [--quiet]\n"
    "       snowshed-run --schema | --version | --help\n"
    "\n"
    "Runs the scene's events and writes into DIR scene.json, run.json,\n"
    "particles.pvd (ParaView), particles/, snapshots/, film.bin and checkpoint.bin.\n"
    "Exit codes: 0 done; 2 bad input, nothing was written; 3 the run started but could not\n"
    "finish (simulation failed, disk full, out of memory); 130 interrupted.\n";

struct Options {
  std::string scene, folder;
  bool resume = false, quiet = false;
};

volatile std::sig_atomic_t interrupted = 0;
volatile std::sig_atomic_t setting_up = 0;  // reading files and building, which writes nothing

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("", what + "; see snowshed-run --help");
}

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i)
    if (!is_utf8(argv[i])) refuse(std::string(argv[i]) + ": this name is not UTF-8");
  for (int i = 1; i < argc; ++i) {
    const std::string a = argv[i];
    if (a == "-o" || a == "--output") {
      if (++i == argc) refuse(a + " needs a folder");
      o.folder = io::with_home(argv[i]);
    } else if (a == "--resume") {
      o.resume = true;
    } else if (a == "-q" || a == "--quiet") {
      o.quiet = true;
    } else if (!a.empty() && a[0] == '-') {
      refuse("unknown option " + a);
    } else if (o.scene.empty()) {
      o.scene = io::with_home(a);
    } else {
      refuse("more than one scene: " + a);
    }
  }
  if (o.scene.empty()) refuse("no scene given");
  if (o.folder.empty()) refuse("no output folder given (-o DIR)");
  return o;
}

/// Shows the progress of the run on one line of the terminal.
class Display : public EventObserver {
 public:
  explicit Display(bool quiet) : quiet_(quiet) {}

  void noted(const std::string& note) override {
    if (!quiet_)
      std::fprintf(stderr, "%snote: %s\n", terminal_ ? "\r" : "", printable(note).c_str());
  }
  void progress(const Simulation& sim, const RunReport& r) override {
    if (!quiet_ && terminal_)
      std::fprintf(stderr, "\revent %d  %3.0f %%  t = %.3f s  %.1f M updates/s ", sim.event(),
                   100 * r.progress, r.time, r.updates_per_s / 1e6);
  }
  void event_ended(const Simulation&, const EventRecord& record) override {
    if (const auto lost = record.energy_residual(); lost > max_energy_residual)
      std::fprintf(stderr, "\rnote: event %d: the energy balance has a residual of %.2g %%\n",
                   record.event, 100 * *lost);
    if (!quiet_)
      std::fprintf(stderr, "%sevent %d  %s after %.3f s of snow time%s\n", terminal_ ? "\r" : "",
                   record.event, record.ended == RunEnd::rest ? "at rest" : "time limit",
                   record.sim_time, terminal_ ? "                              " : "");
  }
  bool stop_requested() override { return interrupted != 0; }

 private:
  bool quiet_;
  bool terminal_ = isatty(STDERR_FILENO) != 0;  // a file or a pipe gets complete lines only
};

/// The Python package computes the effects of time on the stack between events.
void refuse_ageing(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "ageing.json"))
    throw InputError(folder.string(), "its snow ages between events; resume it with: snowshed");
}

EventSequence open(const Options& o) {
  setting_up = 1;
  std::vector<std::string> notes;
  const scene::Scene scene = scene::load_scene(o.scene, &notes);
  for (const std::string& note : notes)
    if (!o.quiet) std::fprintf(stderr, "note: %s\n", printable(o.scene + ": " + note).c_str());
  const auto stop = [] {
    setting_up = 0;  // called while snow is seeded, which can be stopped
    return interrupted != 0;
  };
  if (!o.resume) return EventSequence::create(scene, ".", o.folder, stop);
  refuse_ageing(o.folder);
  auto sequence = EventSequence::resume(scene, ".", o.folder);
  ExternalRecord(sequence).drop_files();
  return sequence;
}

/// Returns whether the run came to its end; after an error, run.json records it.
bool run_all(EventSequence& sequence, bool quiet) try {
  Display display(quiet);
  return sequence.run(display, 0.1);
} catch (const FileError&) {
  throw;
} catch (const std::exception& error) {
  sequence.record_failure(error.what());
  throw;
}

/// A run continues to its next safe point; during setup there is nothing to save.
void on_signal(int) {
  constexpr char message[] = "error: interrupted; nothing was written\n";
  interrupted = 1;
  if (!setting_up) return;
  if (::write(STDERR_FILENO, message, sizeof message - 1) < 0) {
    // It is not read.
  }
  std::_Exit(130);
}

/// A signal that is ignored, as under nohup, remains ignored.
void interrupt_on(int signal) {
  if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
}

int fail(const std::string& message, int code) {
  std::fprintf(stderr, "error: %s\n", printable(message).c_str());
  return code;
}

int run_scene(const Options& o) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) interrupt_on(signal);
  EventSequence sequence = open(o);
  setting_up = 0;
  if (const char* slow = slow_kernels_note(); *slow && !o.quiet)
    std::fprintf(stderr, "note: %s\n", slow);
  if (const std::string note = sequence.simulation().input_note(); !note.empty() && !o.quiet)
    std::fprintf(stderr, "note: %s\n", note.c_str());
  if (!run_all(sequence, o.quiet)) {
    return fail(
        "interrupted; resume with: snowshed-run " + o.scene + " -o " + o.folder + " --resume", 130);
  }
  if (!o.quiet)
    std::fprintf(stderr, "for tables, pictures and all notes: snowshed run %s -o %s --resume\n",
                 printable(o.scene).c_str(), printable(o.folder).c_str());
  return 0;
}

}  // namespace

int run_program(int argc, char** argv) {
  if (argc == 2 && !std::strcmp(argv[1], "--help")) return std::fputs(usage, stdout), 0;
  if (argc == 2 && !std::strcmp(argv[1], "--version")) return std::puts(SNOWSHED_VERSION), 0;
  try {
    if (argc == 2 && !std::strcmp(argv[1], "--schema"))
      return std::puts(scene::scene_schema().c_str()), 0;
    return run_scene(parse(argc, argv));
  } catch (const Stopped&) {
    return fail("interrupted; nothing was written", 130);
  } catch (const SimulationError& error) {
    return fail(error.what(), 3);
  } catch (const std::bad_alloc&) {
    return fail("out of memory: give fewer particles or a larger dx", 3);
  } catch (const FileError& error) {
    return fail(error.what(), error.is_of_disk() ? 3 : 2);
  } catch (const std::exception& error) {
    return fail(error.what(), 2);
  }
}

}  // namespace snowshed::run
