#include "snowshed/run/shape_prints.hpp"

#include "snowshed/io/file_bytes.hpp"
#include "snowshed/io/fingerprint.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {

std::vector<std::int64_t> fingerprints_of_shapes(const Scene& scene,
                                                 const std::filesystem::path& base_dir) {
  std::vector<std::int64_t> values;
  for (const std::string& file : shape_files(scene)) {
    const std::string bytes = read_bytes(base_dir / file);
    Fingerprint print;
    print.add(bytes.data(), bytes.size());
    values.push_back(print.value());
  }
  return values;
}

}  // namespace snowshed
