#include "snowshed/methods/grains/input.hpp"

#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/geometry/readers/npy_io.hpp"
#include "snowshed/io/fingerprint.hpp"

namespace snowshed::methods::grains {
namespace {

/// Throws InputError if the image holds no grain, or its clumps do not fit into memory.
void check_size(const LabelImage& image) {
  const SampleSize size = image.labels.empty() ? SampleSize{} : measure_sample(image);
  if (size.grains == 0)
    throw InputError("", "no grain in the image: every voxel is 0, which is air");
  const double available = double(available_memory_bytes());
  if (double(size.bytes) > available)
    throw InputError("", "its " + std::to_string(size.spheres) + " spheres need " +
                             show_rounded(double(size.bytes) / 1e9) +
                             " GB of memory; available are " + show_rounded(available / 1e9) +
                             " GB; give a smaller image, or one of larger voxels");
}

Sample read_sample(const SampleSpec& spec, const std::filesystem::path& base_dir) {
  const std::filesystem::path file = base_dir / spec.file;
  geometry::NpyLabels array = geometry::read_npy_labels(file);
  LabelImage image;
  image.size = {array.shape[2], array.shape[1], array.shape[0]};
  image.voxel_size = spec.voxel_size;
  image.labels = std::move(array.values);
  try {
    check_size(image);
    const LabelPieces pieces = count_pieces(image);
    check_labels(pieces);
    if (spec.split_labels) split_pieces(image);
    Sample sample = make_sample(image);
    sample.pieces = pieces;
    check_grain_diameter(median_diameter(sample));
    return sample;
  } catch (const InputError& error) {
    throw InputError(file.string(), error.what());
  }
}

}  // namespace

Input::Input(const SampleSpec& spec, const std::filesystem::path& base_dir)
    : file_(spec.file), split_labels_(spec.split_labels), sample_(read_sample(spec, base_dir)) {}

std::vector<FileFingerprint> Input::files() const {
  io::Fingerprint print;
  print.add(sample_.box.data(), 3);
  print.add(&sample_.radius, 1);
  for (const Clump& c : sample_.clumps) {
    print.add(c.center.data(), 3);
    print.add(&c.volume, 1);
    print.add(&c.spheres, 1);
  }
  for (const Vec3& x : sample_.spheres) print.add(x.data(), 3);
  for (const BondedPair& b : sample_.bonds) {
    print.add(&b.first, 1);
    print.add(&b.second, 1);
  }
  return {{file_, print.value()}};
}

}  // namespace snowshed::methods::grains
