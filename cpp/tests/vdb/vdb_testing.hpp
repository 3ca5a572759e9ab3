// OpenVDB files written with OpenVDB itself.
#pragma once

#include <openvdb/openvdb.h>

#include "geometry/geometry_testing.hpp"
#include "snowshed/geometry/readers/vdb_file.hpp"

namespace snowshed::vdb_testing {

inline std::string write(const geometry_testing::TempDir& folder, const openvdb::GridCPtrVec& grids,
                         const std::string& name = "test.vdb") {
  openvdb::initialize();
  const std::string path = (folder.path() / name).string();
  openvdb::io::File file(path);
  file.write(grids);
  file.close();
  return path;
}

inline openvdb::FloatGrid::Ptr named(openvdb::FloatGrid::Ptr grid, const std::string& name) {
  grid->setName(name);
  return grid;
}

}  // namespace snowshed::vdb_testing
