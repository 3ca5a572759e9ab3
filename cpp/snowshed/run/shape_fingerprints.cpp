#include "snowshed/run/shape_fingerprints.hpp"

#include "snowshed/io/file_bytes.hpp"
#include "snowshed/io/fingerprint.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::run {

std::vector<std::int64_t> shape_fingerprints(const scene::Scene& scene,
                                             const std::filesystem::path& base_dir) {
  std::vector<std::int64_t> fingerprints;
  for (const std::string& file : scene::shape_files(scene)) {
    const std::string bytes = io::read_bytes(base_dir / file);
    io::Fingerprint fingerprint;
    fingerprint.add(bytes.data(), bytes.size());
    fingerprints.push_back(fingerprint.value());
  }
  return fingerprints;
}

}  // namespace snowshed::run
