// Contents of a file of particles.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "snowshed/io/vtp_writer.hpp"

namespace snowshed::methods {

struct PointCloud {
  std::vector<std::array<float, 3>> points;  // m
  std::vector<io::PointArray> arrays;
  io::PointPairs lines;

  /// A cloud with a velocity at each point.
  template <class Vectors>
  static PointCloud moving(const Vectors& positions, const Vectors& velocities) {
    PointCloud cloud;
    std::vector<float> velocity;
    cloud.points.reserve(positions.size());
    velocity.reserve(3 * positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const auto x = positions[i].template cast<float>(), v = velocities[i].template cast<float>();
      cloud.points.push_back({x[0], x[1], x[2]});
      velocity.insert(velocity.end(), {v[0], v[1], v[2]});
    }
    cloud.arrays.push_back({"velocity", 3, std::move(velocity)});
    return cloud;
  }

  /// Adds one value for each point.
  template <class To, class From>
  void add(const char* name, const std::vector<From>& values) {
    arrays.push_back({name, 1, std::vector<To>(values.begin(), values.end())});
  }

  /// Replaces the values of an array.
  template <class To>
  void replace(const std::string& name, std::vector<To> values) {
    for (io::PointArray& array : arrays)
      if (array.name == name) array.values = std::move(values);
  }
};

}  // namespace snowshed::methods
