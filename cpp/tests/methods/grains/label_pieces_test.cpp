#include "snowshed/methods/grains/label_pieces.hpp"

#include <gtest/gtest.h>

#include <set>

#include "io/temporary_folder.hpp"
#include "methods/grains/grains_testing.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/methods/grains/clumps.hpp"

namespace snowshed::methods::grains {
namespace {

/// Blocks of 3^3 voxels with gaps of one voxel. The label of a block is number(index).
template <class Number>
LabelImage blocks(std::size_t n, const Number& number) {
  return image_of(4 * n, 4 * n, 4 * n, [&](std::size_t i, std::size_t j, std::size_t k) {
    if (i % 4 == 3 || j % 4 == 3 || k % 4 == 3) return 0;
    return number(int((k / 4 * n + j / 4) * n + i / 4));
  });
}

TEST(LabelPieces, ConnectedLabelsHaveOnePieceEach) {
  const LabelPieces counts = count_pieces(blocks(3, [](int block) { return block + 1; }));
  EXPECT_EQ(counts.labels, 27u);
  EXPECT_EQ(counts.pieces, 27u);
  EXPECT_EQ(counts.scattered, 0u);
  EXPECT_EQ(counts.voxels, 27u * 27u);
  EXPECT_EQ(label_note(counts, false), "");
}

TEST(LabelPieces, WrappedLabelsAreCountedAndSplit) {
  LabelImage image = blocks(3, [](int block) { return block % 5 + 1; });
  const LabelPieces counts = count_pieces(image);
  EXPECT_EQ(counts.labels, 5u);
  EXPECT_EQ(counts.pieces, 27u);
  EXPECT_EQ(counts.scattered, 5u);
  EXPECT_NE(label_note(counts, false).find("5 of 5 labels lie in several places, 27 pieces in all"),
            std::string::npos);
  EXPECT_NE(label_note(counts, true).find("each piece is a grain"), std::string::npos);
  EXPECT_EQ(make_sample(image).clumps.size(), 5u);
  split_pieces(image);
  const Sample split = make_sample(image);
  EXPECT_EQ(split.clumps.size(), 27u);
  for (const Clump& c : split.clumps) EXPECT_NEAR(c.volume, 27 * std::pow(test_voxel, 3), 1e-20);
  EXPECT_EQ(label_note(count_pieces(image), true), "");
}

TEST(LabelPieces, FacesEdgesAndCornersConnectVoxels) {
  for (const int corner : {1, 2, 3}) {  // the second voxel shares a face, an edge, a corner
    const LabelImage image = image_of(2, 2, 2, [&](std::size_t i, std::size_t j, std::size_t k) {
      const bool first = i + j + k == 0;
      const bool second = i == 1 && j == std::size_t(corner > 1) && k == std::size_t(corner > 2);
      return first || second ? 7 : 0;
    });
    EXPECT_EQ(count_pieces(image).pieces, 1u);
  }
}

TEST(LabelPieces, GreyValuesAreRefused) {
  const LabelImage grey = image_of(20, 20, 20, [](std::size_t i, std::size_t j, std::size_t k) {
    return int((i * 7 + j * 13 + k * 29 + i * j * 3 + j * k * 5) % 200) + 20;
  });
  EXPECT_NE(io::message_of<InputError>([&] {
              check_labels(count_pieces(grey));
            }).find("not a label image"),
            std::string::npos);
  EXPECT_NO_THROW(check_labels(count_pieces(blocks(4, [](int block) { return block % 2 + 1; }))));
}

TEST(LabelPieces, ASingleLabelIsNoted) {
  const LabelImage image = blocks(1, [](int) { return 255; });
  EXPECT_NE(label_note(count_pieces(image), false).find("all ice has the same label"),
            std::string::npos);
}

TEST(GrainDiameter, MustBePlausibleForSnow) {
  EXPECT_NO_THROW(check_grain_diameter(5e-4));
  for (const double wrong : {0.5, 1e-6, 0.0})
    EXPECT_NE(
        io::message_of<InputError>([&] { check_grain_diameter(wrong); }).find("wrongly scaled"),
        std::string::npos);
  const Sample sample = make_sample(blocks(2, [](int block) { return block + 1; }));
  EXPECT_NEAR(median_diameter(sample), 3 * test_voxel * std::cbrt(6 / 3.14159265358979), 1e-9);
}

}  // namespace
}  // namespace snowshed::methods::grains
