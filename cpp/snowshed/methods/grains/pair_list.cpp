#include "snowshed/methods/grains/pair_list.hpp"

#include <algorithm>

namespace snowshed::methods::grains {
namespace {

bool same_group(const PairGroup& g, const PairKey& k) {
  return g.first == k.first && g.second == k.second && g.shift[0] == k.shift[0] &&
         g.shift[1] == k.shift[1];
}

/// Fills a list whose memory is reserved.
class ListWriter {
 public:
  ListWriter(const PairSearch& search, PairList& list) : search_(search), list_(list) {}

  void add(const PairKey& key, const Vec3& shear, bool bonded) {
    std::vector<PairGroup>& groups = list_.groups;
    if (groups.empty() || !same_group(groups.back(), key)) {
      close_group();
      const std::uint32_t at = std::uint32_t(list_.size());
      groups.push_back({key.first, key.second, {key.shift[0], key.shift[1]}, at, at});
    }
    const bool of_grain = key.second < search_.grains;
    const bool of_plate = key.second < search_.grains + std::uint32_t(Partner::west);
    const Vec3 b = of_grain   ? search_.spheres.offsets[key.b]
                   : of_plate ? plate_sphere(key.b, search_.radius)
                              : Vec3(Vec3::Zero());
    push(key.a, key.b, search_.spheres.offsets[key.a], b, shear, bonded);
  }

  /// Fills up the last group with pairs that never touch.
  void close_group() {
    if (list_.groups.empty()) return;
    const double far = 1e6 * search_.radius;
    while (list_.size() % pairs_at_once != 0)
      push(no_sphere_index, 0, Vec3::Zero(), Vec3(far, far, far), Vec3::Zero(), false);
    list_.groups.back().end = std::uint32_t(list_.size());
  }

 private:
  void push(std::uint32_t a, std::uint32_t b, const Vec3& from_a, const Vec3& from_b,
            const Vec3& shear, bool bonded) {
    list_.a.push_back(a);
    list_.b.push_back(b);
    list_.ax.push_back(from_a.x());
    list_.ay.push_back(from_a.y());
    list_.az.push_back(from_a.z());
    list_.bx.push_back(from_b.x());
    list_.by.push_back(from_b.y());
    list_.bz.push_back(from_b.z());
    list_.ux.push_back(shear.x());
    list_.uy.push_back(shear.y());
    list_.uz.push_back(shear.z());
    list_.bonded.push_back(bonded);
  }

  const PairSearch& search_;
  PairList& list_;
};

/// Calls visit(key, history or null) for each listed pair, in order.
template <class Visit>
void for_each_listed(const std::vector<PairKey>& pairs, const std::vector<PairHistory>& past,
                     const Visit& visit) {
  std::size_t h = 0;
  const auto skip_until = [&](const PairKey* key) {
    for (; h < past.size() && (!key || past[h].key < *key); ++h)
      if (past[h].always_listed) visit(past[h].key, &past[h]);
  };
  for (const PairKey& key : pairs) {
    skip_until(&key);
    const bool known = h < past.size() && past[h].key == key;
    visit(key, known ? &past[h] : nullptr);
    if (known) ++h;
  }
  skip_until(nullptr);
}

}  // namespace

bool operator<(const PairKey& x, const PairKey& y) {
  if (x.first != y.first) return x.first < y.first;
  if (x.second != y.second) return x.second < y.second;
  if (x.shift[0] != y.shift[0]) return x.shift[0] < y.shift[0];
  if (x.shift[1] != y.shift[1]) return x.shift[1] < y.shift[1];
  if (x.a != y.a) return x.a < y.a;
  return x.b < y.b;
}
bool operator==(const PairKey& x, const PairKey& y) { return !(x < y) && !(y < x); }

std::vector<PairHistory> PairList::histories() const {
  std::vector<PairHistory> past;
  for (const PairGroup& g : groups)
    for (std::size_t p = g.begin; p < g.end; ++p)
      if (is_pair(p) && (bonded[p] || !shear(p).isZero(0.0)))
        past.push_back({key(g, p), shear(p), bonded[p] != 0, bonded[p] != 0});
  return past;
}

std::vector<PairHistory> PairList::all() const {
  std::vector<PairHistory> past;
  past.reserve(size());
  for (const PairGroup& g : groups)
    for (std::size_t p = g.begin; p < g.end; ++p)
      if (is_pair(p)) past.push_back({key(g, p), shear(p), bonded[p] != 0, true});
  return past;
}

std::size_t PairList::bytes() const {
  return groups.capacity() * sizeof(PairGroup) + ax.capacity() * (9 * sizeof(double) + 1) +
         (a.capacity() + b.capacity()) * sizeof(std::uint32_t);
}

PairList make_list(const PairSearch& search, const std::vector<PairKey>& pairs,
                   const std::vector<PairHistory>& past) {
  std::size_t entries = 0, groups = 0;
  const PairKey* last = nullptr;
  for_each_listed(pairs, past, [&](const PairKey& key, const PairHistory*) {
    const bool opens = !last || last->first != key.first || last->second != key.second ||
                       last->shift[0] != key.shift[0] || last->shift[1] != key.shift[1];
    if (opens) {
      entries = (entries + pairs_at_once - 1) / pairs_at_once * pairs_at_once;
      ++groups;
    }
    ++entries;
    last = &key;
  });
  entries = (entries + pairs_at_once - 1) / pairs_at_once * pairs_at_once;
  PairList list;
  list.groups.reserve(groups);
  for (auto* array :
       {&list.ax, &list.ay, &list.az, &list.bx, &list.by, &list.bz, &list.ux, &list.uy, &list.uz})
    array->reserve(entries);
  list.bonded.reserve(entries);
  list.a.reserve(entries);
  list.b.reserve(entries);
  ListWriter writer(search, list);
  for_each_listed(pairs, past, [&](const PairKey& key, const PairHistory* known) {
    writer.add(key, known ? known->shear : Vec3(Vec3::Zero()), known && known->bonded);
  });
  writer.close_group();
  return list;
}

BodyGroups groups_of_bodies(const PairList& list, std::size_t grains) {
  BodyGroups of;
  of.begin.assign(grains + 1, 0);
  const auto count = [&](std::uint32_t body) {
    if (body < grains) ++of.begin[body + 1];
  };
  for (const PairGroup& g : list.groups) {
    count(g.first);
    count(g.second);
  }
  for (std::size_t i = 0; i < grains; ++i) of.begin[i + 1] += of.begin[i];
  of.entry.resize(of.begin[grains]);
  std::vector<std::uint32_t> next(of.begin.begin(), of.begin.end() - 1);
  for (std::size_t g = 0; g < list.groups.size(); ++g) {
    of.entry[next[list.groups[g].first]++] = std::uint32_t(2 * g);
    if (list.groups[g].second < grains)
      of.entry[next[list.groups[g].second]++] = std::uint32_t(2 * g + 1);
  }
  return of;
}

}  // namespace snowshed::methods::grains
