#include "snowshed/geometry/readers/vdb_file.hpp"

#include <csignal>
#include <cstring>

#include "snowshed/core/child_process.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/geometry/readers/vdb_message.hpp"
#include "snowshed/geometry/rebuild_distance.hpp"
#include "snowshed/io/file_bytes.hpp"

namespace snowshed::geometry {
namespace {

std::string where(const VdbSource& source) {
  return source.path.string() + (source.grid.empty() ? "" : ": grid '" + source.grid + "'");
}

/// Returns the output of snowshed-vdb. Throws InputError if it refused the file or crashed on it.
std::string run_reader(const VdbSource& source) {
  const auto program = find_sibling_program("snowshed-vdb");
  if (!program)
    throw InputError(where(source),
                     "reading it needs OpenVDB, without which this snowshed was built; install it "
                     "(Debian, Ubuntu: libopenvdb-dev libboost-dev) and build snowshed again");
  io::check_readable(source.path);
  const ChildResult result = run_child(*program, {"read", source.path.string(), source.grid});
  if (result.signal == SIGXCPU)
    throw InputError(where(source), "damaged: reading it does not come to an end");
  if (result.signal != 0)
    throw InputError(where(source), "damaged: OpenVDB crashed on it (signal " +
                                        std::to_string(result.signal) + ")");
  if (result.exit_code == 2) throw InputError(where(source), result.output);
  if (result.exit_code != 0)
    throw InputError(where(source), program->string() + " failed with exit code " +
                                        std::to_string(result.exit_code));
  return result.output;
}

/// Returns the header of the answer, checked against its length.
VdbHeader take_header(const std::string& answer) {
  VdbHeader header;
  if (answer.size() >= sizeof header) std::memcpy(&header, answer.data(), sizeof header);
  const std::size_t samples = header.counts[0] * header.counts[1] * header.counts[2];
  if (header.mark != VdbHeader::expected_mark || samples > max_vdb_samples ||
      answer.size() != sizeof header + samples * sizeof(float))
    throw InputError("snowshed-vdb", "of another version of snowshed; build both together");
  return header;
}

/// Replaces densities by values that are negative in the solid.
void subtract_from(double threshold, std::vector<float>& values) {
  for (float& value : values) value = static_cast<float>(threshold - value);
}

}  // namespace

GridSamples read_vdb(const VdbSource& source) {
  const std::string answer = run_reader(source);
  const VdbHeader header = take_header(answer);
  GridSamples samples;
  samples.origin = source.scale * Vec3(header.origin[0], header.origin[1], header.origin[2]);
  samples.spacing = source.scale * header.spacing;
  for (int axis = 0; axis < 3; ++axis) samples.counts[axis] = header.counts[axis];
  samples.values.resize((answer.size() - sizeof header) / sizeof(float));
  std::memcpy(samples.values.data(), answer.data() + sizeof header, answer.size() - sizeof header);
  if (header.kind == VdbKind::fog_volume) {
    subtract_from(source.threshold, samples.values);
    rebuild_distance(samples, 0, where(source));
  } else {
    for (float& value : samples.values) value = static_cast<float>(source.scale * value);
    // Because of the factor, values clipped at the band lie outside it despite rounding.
    rebuild_distance(samples, 0.999 * source.scale * header.background, where(source));
  }
  return samples;
}

}  // namespace snowshed::geometry
