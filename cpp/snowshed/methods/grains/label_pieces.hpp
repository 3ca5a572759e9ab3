// Labels of several unconnected pieces, because label numbers were wrapped or used twice.
#pragma once

#include <cstddef>
#include <string>

#include "snowshed/methods/grains/label_image.hpp"

namespace snowshed::methods::grains {

/// Number of labels in an image, and of their pieces. Voxels of one label belong to one piece if
/// they share a face, an edge or a corner.
struct LabelPieces {
  std::size_t labels = 0;
  std::size_t pieces = 0;
  std::size_t scattered = 0;  // labels of several pieces
  std::size_t voxels = 0;     // voxels of all labels
};
LabelPieces count_pieces(const LabelImage&);

/// Throws InputError if the labels are grey values, which change from voxel to voxel.
void check_labels(const LabelPieces&);

/// Note for the user about labels in several pieces, with or without `split_pieces`. Returns an
/// empty text if each label is one piece.
std::string label_note(const LabelPieces&, bool split);

/// Makes each piece a label of its own, from 1 on in the order of storage.
void split_pieces(LabelImage&);

}  // namespace snowshed::methods::grains
