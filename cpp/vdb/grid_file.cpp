#include "grid_file.hpp"

#include <algorithm>

#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

bool holds_floats(const openvdb::io::GridDescriptor& grid) {
  return grid.gridType() == openvdb::FloatGrid::gridType();
}

std::string name_of(const openvdb::io::GridDescriptor& grid) {
  return openvdb::io::GridDescriptor::nameAsString(grid.uniqueName());
}

}  // namespace

// These calls are in the order of io::File::open.
GridFile::GridFile(const std::string& path) : stream_(path, std::ios::binary) {
  stream_.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
  openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/false);
  readHeader(stream_);
  setFormatVersion(stream_);
  setLibraryVersion(stream_);
  setDataCompression(stream_);
  openvdb::MetaMap().readMeta(stream_);
  if (!inputHasGridOffsets())
    throw InputError("", "written as a stream, without a list of grids; write it as a file");
  for (openvdb::Int32 i = 0, count = readGridCount(stream_); i < count; ++i) {
    openvdb::io::GridDescriptor grid;
    grid.read(stream_);
    grids_.push_back(grid);
    if (i + 1 < count) grid.seekToEnd(stream_);
  }
}

openvdb::FloatGrid::Ptr GridFile::read(const std::string& name) {
  openvdb::io::GridDescriptor descriptor = find(name);
  if (descriptor.isInstance())
    throw InputError("", "it shares the tree of another grid; name that one, '" +
                             descriptor.instanceParentName() + "'");
  // The stream may still hold the settings of another grid; those of this one replace them.
  stream_.seekg(descriptor.getGridPos());
  const auto grid = openvdb::FloatGrid::create();
  grid->setSaveFloatAsHalf(descriptor.saveFloatAsHalf());
  readGrid(grid, descriptor, stream_);
  return grid;
}

const openvdb::io::GridDescriptor& GridFile::find(const std::string& name) const {
  const auto fits = [&](const auto& grid) {
    return name.empty() ? holds_floats(grid) : name_of(grid) == name || grid.gridName() == name;
  };
  const auto grid = std::find_if(grids_.begin(), grids_.end(), fits);
  if (grid == grids_.end())
    throw InputError("", (name.empty() ? "no grid of floats" : "no such grid") + list());
  if (!holds_floats(*grid))
    throw InputError(
        "", "a grid of type " + grid->gridType() + "; allowed: " + openvdb::FloatGrid::gridType());
  if (name.empty() && std::count_if(grids_.begin(), grids_.end(), fits) > 1)
    throw InputError("", "more than one grid of floats; give the name of one" + list());
  return *grid;
}

std::string GridFile::list() const {
  constexpr std::size_t max_listed = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(max_listed, grids_.size()); ++i)
    text += (i ? ", '" : "; the file holds '") + name_of(grids_[i]) + "' (" + grids_[i].gridType() +
            ")";
  if (grids_.size() > max_listed)
    text += " and " + std::to_string(grids_.size() - max_listed) + " more";
  return grids_.empty() ? "; the file holds none" : text;
}

}  // namespace snowshed
