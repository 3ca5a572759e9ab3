// Particle snapshots as VTK PolyData (.vtp), which ParaView and VisIt open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace snowshed::io {

/// A quantity with `components` consecutive values at each point.
struct PointArray {
  std::string name;
  int components = 1;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int32_t>,
               std::vector<std::uint16_t>, std::vector<std::uint8_t>>
      values;
};

/// Lines, each by the indices of its two points.
using PointPairs = std::vector<std::array<std::uint32_t, 2>>;

/// Writes each point (metres) as a vertex, and lines, atomically. Throws FileError if that fails,
/// and std::invalid_argument if an array's length is not `components` times the number of points.
void write_vtp(const std::filesystem::path& path, const std::vector<std::array<float, 3>>& points,
               const std::vector<PointArray>& arrays, const PointPairs& lines = {});
void write_vtp(const std::filesystem::path& path, const std::vector<std::array<double, 3>>& points,
               const std::vector<PointArray>& arrays);

/// Writes faces with the same number of corners each, at least 2: lines, or polygons. `corners` has
/// the points (metres) of one face after the other; `arrays` has the values of each face. Throws as
/// `write_vtp`.
void write_faces_vtp(const std::filesystem::path& path,
                     const std::vector<std::array<double, 3>>& corners, std::size_t per_face,
                     const std::vector<PointArray>& arrays);

}  // namespace snowshed::io
