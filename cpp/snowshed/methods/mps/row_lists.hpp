// Lists of any type, one for each particle, in one array.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "snowshed/core/parallel.hpp"

namespace snowshed::methods::mps {

template <class T>
class RowLists {
 public:
  const T* begin(std::size_t i) const { return all_.data() + first_[i]; }
  const T* end(std::size_t i) const { return all_.data() + first_[i + 1]; }
  const std::vector<T>& all() const { return all_; }
  /// The index of an entry in all().
  std::size_t index_of(const T* entry) const { return std::size_t(entry - all_.data()); }

  /// Replaces the lists: make(begin, end, first, list) appends the lists of the particles [begin,
  /// end) to `list`, one after another, and sets first[i + 1] to the length of each.
  template <class Make>
  void update(std::size_t particles, std::size_t in_part, int threads, const Make& make) {
    const std::size_t parts = (particles + in_part - 1) / in_part;
    parts_.resize(std::max(parts, parts_.size()));
    first_.assign(particles + 1, 0);
    parallel_for_dynamic(std::ptrdiff_t(parts), threads, 1, [&](std::ptrdiff_t p) {
      const std::size_t begin = std::size_t(p) * in_part;
      parts_[std::size_t(p)].clear();
      make(begin, std::min(particles, begin + in_part), first_.data(), parts_[std::size_t(p)]);
    });
    for (std::size_t i = 0; i < particles; ++i) first_[i + 1] += first_[i];
    all_.clear();
    for (std::size_t p = 0; p < parts; ++p)
      all_.insert(all_.end(), parts_[p].begin(), parts_[p].end());
  }

  std::size_t bytes() const {
    return 2 * all_.capacity() * sizeof(T) + first_.capacity() * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint32_t> first_{0};
  std::vector<T> all_;
  std::vector<std::vector<T>> parts_;
};

}  // namespace snowshed::methods::mps
