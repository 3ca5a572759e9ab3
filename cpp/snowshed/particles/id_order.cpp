#include "snowshed/particles/id_order.hpp"

#include <array>
#include <numeric>

namespace snowshed::particles {
namespace {

constexpr int digit_bits = 11;  // three digits make an id, and the counts fit into the cache
constexpr std::uint32_t digits = 1u << digit_bits;

/// Stable counting sort by one digit of the ids.
void sort_by_digit(const std::uint32_t* ids, int shift, std::vector<std::uint32_t>& order,
                   std::vector<std::uint32_t>& sorted) {
  const auto digit = [ids, shift](std::uint32_t place) {
    return (ids[place] >> shift) & (digits - 1);
  };
  std::array<std::uint32_t, digits + 1> next{};
  for (std::uint32_t place : order) ++next[digit(place) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::uint32_t place : order) sorted[next[digit(place)]++] = place;
  order.swap(sorted);
}

}  // namespace

std::vector<std::uint32_t> order_by_id(const std::uint32_t* ids, std::size_t count) {
  std::vector<std::uint32_t> order(count), sorted(count);
  std::iota(order.begin(), order.end(), 0u);
  for (int shift = 0; shift < 32; shift += digit_bits) sort_by_digit(ids, shift, order, sorted);
  return order;
}

}  // namespace snowshed::particles
