// Input of grains from a file: their sample.
#pragma once

#include <filesystem>

#include "snowshed/methods/grains/clumps.hpp"
#include "snowshed/methods/scene_parts.hpp"
#include "snowshed/methods/surroundings.hpp"

namespace snowshed::methods::grains {

class Input final : public MethodInput {
 public:
  /// Reads the image, checks that its clumps fit into memory, and makes them. Throws InputError.
  Input(const SampleSpec&, const std::filesystem::path& base_dir);

  const char* section() const override { return "sample"; }
  std::vector<FileFingerprint> files() const override;
  std::string note() const override { return label_note(sample_.pieces, split_labels_); }

  const Sample& sample() const { return sample_; }

 private:
  std::string file_;
  bool split_labels_;
  Sample sample_;
};

}  // namespace snowshed::methods::grains
