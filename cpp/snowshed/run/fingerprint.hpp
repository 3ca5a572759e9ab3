// Numbers that tell whether a file is still the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "snowshed/scene/build_method.hpp"
#include "snowshed/scene/scene.hpp"

namespace snowshed {

/// A number that is another one for other bytes, but for rare accidents (FNV-1a, 64 bits).
class Fingerprint {
 public:
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); ++i)
      value_ = (value_ ^ bytes[i]) * 1099511628211ull;
  }
  void add(const HeightField& f) {
    const double place[] = {f.cell, f.west, f.south, double(f.columns), double(f.rows)};
    add(place, std::size(place));
    add(f.heights.data(), f.heights.size());
  }
  void add(const GrainSample& s) {
    add(s.box.data(), 3);
    add(&s.radius, 1);
    for (const Clump& c : s.clumps) {
      add(c.centre.data(), 3);
      add(&c.volume, 1);
      add(&c.spheres, 1);
    }
    for (const Vec3& x : s.spheres) add(x.data(), 3);
    for (const BondedPair& b : s.bonds) {
      add(&b.first, 1);
      add(&b.second, 1);
    }
  }
  std::int64_t value() const { return std::int64_t(value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

/// The fingerprints of the mesh and grid files that a scene names, in the order of `shape_files`.
std::vector<std::int64_t> fingerprints_of_shapes(const Scene& scene,
                                                 const std::filesystem::path& base_dir);

}  // namespace snowshed
