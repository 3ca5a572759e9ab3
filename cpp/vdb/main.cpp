// snowshed-vdb: the program that reads and writes OpenVDB files for snowshed, in a separate
// process.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <string>

#include "grid_file.hpp"
#include "particle_message.hpp"
#include "read_samples.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/core/version.hpp"

namespace {

constexpr const char* usage =
    "usage: snowshed-vdb read FILE GRID\n"
    "       snowshed-vdb write FILE < PARTICLES\n"
    "       snowshed-vdb --version\n"
    "\n"
    "Started by snowshed to read and write OpenVDB files; for everyday use see `snowshed vdb`.\n"
    "Exit codes: 0 done, 2 refused; standard output then says why.\n";

void set_limit(int resource, rlim_t value) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(value, limit.rlim_max);
  ::setrlimit(resource, &limit);
}

/// Limits memory and time, because OpenVDB may use any amount on a damaged file. The limits are
/// many times the needs of a sound file. A sound file has at least a bit for each byte in memory,
/// and 10 MB of it are read in far less than a second.
void limit_by_size_of(const std::string& path) {
  std::error_code error;
  const auto bytes = rlim_t(std::filesystem::file_size(path, error));
  if (error) return;
  set_limit(RLIMIT_AS, (rlim_t(2) << 30) + 8 * bytes);
  set_limit(RLIMIT_CPU, 2 + bytes / 10'000'000);
  set_limit(RLIMIT_CORE, 0);
}

void read(const std::string& path, const std::string& grid) {
  limit_by_size_of(path);
  const snowshed::VdbSamples samples = snowshed::read_samples(path, grid);
  std::cout.write(reinterpret_cast<const char*>(&samples.header), sizeof samples.header);
  std::cout.write(reinterpret_cast<const char*>(samples.values.data()),
                  std::streamsize(samples.values.size() * sizeof(float)));
}

void write(const std::string& path) {
  const snowshed::WriteRequest request = snowshed::read_request(std::cin);
  const auto summary = snowshed::write_particles(path, request.cloud, request.settings);
  std::cout << nlohmann::json{{"surface_voxels", summary.surface_voxels},
                              {"density_voxels", summary.density_voxels},
                              {"volume_m3", summary.volume},
                              {"mass_kg", summary.mass}};
}

/// Writes the reason, and nothing else, to standard output. The process that started this one reads
/// it there.
int refuse(const std::string& why) {
  std::cout << why << std::flush;
  return 2;
}

int run(int argc, char** argv) {
  const std::string task = argc > 1 ? argv[1] : "";
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  openvdb::initialize();
  if (task == "read" && argc == 4) {
    read(argv[2], argv[3]);
  } else if (task == "write" && argc == 3) {
    write(argv[2]);
  } else if (task == "--version") {
    std::cout << "snowshed-vdb " << SNOWSHED_VERSION << ", OpenVDB "
              << openvdb::getLibraryVersionString() << "\n";
  } else {
    std::cerr << usage;
    return task == "--help" ? 0 : 2;
  }
  std::cout.flush();
  return std::cout ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const snowshed::InputError& error) {
    return refuse(error.what());
  } catch (const openvdb::Exception& error) {
    return refuse(std::string("not a sound OpenVDB file: ") + error.what());
  } catch (const std::ios_base::failure&) {
    return refuse("the file ends too early or is damaged");
  } catch (const std::bad_alloc&) {
    return refuse("damaged: it asks for more memory than a file of its size needs");
  } catch (const std::exception& error) {
    return refuse(std::string("damaged: ") + error.what());
  }
}
