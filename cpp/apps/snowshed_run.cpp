// snowshed-run: a JSON scene in, results out. No Python.
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include "run_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace {

constexpr const char* usage =
    "usage: snowshed-run SCENE.json -o DIR [--resume] [--quiet]\n"
    "       snowshed-run --schema | --version | --help\n"
    "\n"
    "Runs the scene's events and writes into DIR scene.json, run.json,\n"
    "particles.pvd (ParaView), particles/, snapshots/ and checkpoint.bin.\n"
    "Exit codes: 0 done, 2 bad input, 3 the simulation could not go on, 130 interrupted.\n";

struct Options {
  std::string scene, folder;
  bool resume = false, quiet = false;
};

volatile std::sig_atomic_t interrupted = 0;

[[noreturn]] void refuse(const std::string& what) {
  throw snowshed::InputError("", what + "; see snowshed-run --help");
}

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string a = argv[i];
    if (a == "-o" || a == "--output") {
      if (++i == argc) refuse(a + " needs a folder");
      o.folder = argv[i];
    } else if (a == "--resume") {
      o.resume = true;
    } else if (a == "-q" || a == "--quiet") {
      o.quiet = true;
    } else if (!a.empty() && a[0] == '-') {
      refuse("unknown option " + a);
    } else if (o.scene.empty()) {
      o.scene = a;
    } else {
      refuse("more than one scene: " + a);
    }
  }
  if (o.scene.empty()) refuse("no scene given");
  if (o.folder.empty()) refuse("no output folder given (-o DIR)");
  return o;
}

int run(const Options& o) {
  const snowshed::Scene scene = snowshed::load_scene(o.scene);
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });
  const auto go_on = [] { return interrupted == 0; };
  if (snowshed::run_into_folder(scene, o.folder, o.resume, o.quiet, go_on)) return 0;
  std::fprintf(stderr, "error: interrupted; go on with: snowshed-run %s -o %s --resume\n",
               o.scene.c_str(), o.folder.c_str());
  return 130;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && !std::strcmp(argv[1], "--help")) return std::fputs(usage, stdout), 0;
  if (argc == 2 && !std::strcmp(argv[1], "--version")) return std::puts(SNOWSHED_VERSION), 0;
  try {
    if (argc == 2 && !std::strcmp(argv[1], "--schema"))
      return std::puts(snowshed::scene_schema().c_str()), 0;
    return run(parse(argc, argv));
  } catch (const snowshed::SimulationError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
