#include "snowshed/methods/slide/advance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>

#include "snowshed/core/angles.hpp"

namespace snowshed::methods::slide {

void advance(const Model& model, State& state, Workspace& work) {
  const Particles& p = state.particles;
  const View view = view_of(model, state, work);
  for_each_piece(work, p.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    work.piece_sums[std::size_t(begin / particles_in_piece)] =
        chosen_kernels().advance(view, begin, end);
  });
  // The sum is made piece by piece, so that it does not depend on the threads.
  const std::ptrdiff_t pieces =
      (std::ptrdiff_t(p.size()) + particles_in_piece - 1) / particles_in_piece;
  state.kinetic_energy =
      std::accumulate(work.piece_sums.begin(), work.piece_sums.begin() + pieces, 0.0);
}

void find_stop(const Model& model, State& state) {
  state.peak_kinetic = std::max(state.peak_kinetic, state.kinetic_energy);
  state.stopped = state.kinetic_energy <= model.settings.stop_ratio * state.peak_kinetic;
}

namespace {

/// Keeps the entries of an array whose particles stay.
template <class Array>
void keep(const std::vector<std::uint32_t>& new_index, Array& array) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < new_index.size(); ++i)
    if (new_index[i] != removed_particle) array[count++] = array[i];
  array.resize(count);
}

/// Puts the entries of an array into an order; the scratch has room for all of them.
template <class Array>
void reorder(const std::vector<std::uint32_t>& order, AlignedVector<double>& scratch, int threads,
             Array& array) {
  using Entry = typename Array::value_type;
  static_assert(sizeof(Entry) <= sizeof(double) && std::is_trivially_copyable_v<Entry>);
  auto* sorted = reinterpret_cast<Entry*>(scratch.data());
  const auto n = std::ptrdiff_t(order.size());
  parallel_for_static(n, threads, [&](std::ptrdiff_t e) { sorted[e] = array[order[e]]; });
  parallel_for_static(n, threads, [&](std::ptrdiff_t e) { array[e] = sorted[e]; });
}

/// Counts the bonds of the particles that become ground.
void count_bonds_in_ground(State& state, const Workspace& work) {
  for (std::size_t b = 0; b < state.bonds.size(); ++b)
    state.bonds_in_ground += work.removed[state.bonds.first[b]] == became_ground ||
                             work.removed[state.bonds.second[b]] == became_ground;
}

}  // namespace

void remove_marked(State& state, Workspace& work) {
  const auto has_mark = [&](char mark) {
    return std::memchr(work.removed.data(), mark, work.removed.size()) != nullptr;
  };
  if (!has_mark(left_terrain) && !(state.ground && has_mark(became_ground))) return;
  Particles& p = state.particles;
  if (state.ground) count_bonds_in_ground(state, work);
  std::vector<std::uint32_t>& new_index = work.new_indices;
  new_index.resize(p.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    new_index[i] = work.removed[i] ? removed_particle : count++;
    if (work.removed[i] == became_ground) {
      state.balance.stopped += p.mass[i];
      continue;
    }
    if (!work.removed[i] || (!work.gone.empty() && work.gone[i])) continue;
    state.balance.left_terrain += p.mass[i];
    ++state.balance.particles_left;
  }
  p.for_each_array([&](const char*, auto& array) { keep(new_index, array); });
  CellPositions::for_each_array(work.cell_positions, [&](auto& array) { keep(new_index, array); });
  keep(new_index, work.thickness);
  if (state.ground)
    for (std::vector<double>* masses : {&work.entrained, &work.detrained})
      if (!masses->empty()) keep(new_index, *masses);
  renumber(state.bonds, new_index);
  work.bond_lists.update(state.bonds, p.size());
}

namespace {

/// Gives new ids to the particles from `begin` on, which still have the ids of the particles that
/// were split. The new ids follow the order of these ids, so that they do not depend on the order
/// of storage.
void number_new(State& state, Workspace& work, std::size_t begin) {
  Particles& p = state.particles;
  std::vector<std::uint32_t>& order = work.new_indices;
  order.resize(p.size() - begin);
  std::iota(order.begin(), order.end(), std::uint32_t(begin));
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return p.id[a] < p.id[b]; });
  for (const std::uint32_t i : order) p.id[i] = state.next_id++;
}

}  // namespace

void split_heavy(const Model& model, State& state, Workspace& work) {
  Particles& p = state.particles;
  if (work.no_particle_splits || (state.erodible.empty() && !model.compatible())) return;
  const std::size_t before = p.size();
  const Terrain& terrain = present_terrain(model, state);
  for (std::size_t i = 0; i < before; ++i) {
    if (!(p.mass[i] > p.fresh_mass[i] * model.settings.split_ratio)) continue;
    const double area =
        p.mass[i] / (model.settings.density * std::max(work.thickness[i], min_thickness));
    const double distance = 0.41 * std::sqrt(area / pi);
    Vec3 along{p.ux[i], p.uy[i], p.uz[i]};
    const double speed = along.norm();
    along = speed > 0 ? Vec3(along * (distance / speed)) : Vec3(distance, 0, 0);
    const Vec3 x{p.x[i], p.y[i], p.z[i]};
    const geometry::CellPosition behind =
        terrain.cell_position(x.x() - along.x(), x.y() - along.y());
    const geometry::CellPosition ahead =
        terrain.cell_position(x.x() + along.x(), x.y() + along.y());
    if (!behind.inside() || !ahead.inside() || !terrain.known(behind) || !terrain.known(ahead))
      continue;
    p.for_each_array([i](const char*, auto& array) { array.push_back(array[i]); });
    p.mass[i] = p.mass.back() = 0.5 * p.mass[i];
    const auto put = [&](std::size_t at, const Vec3& to, const geometry::CellPosition& position) {
      p.x[at] = to.x();
      p.y[at] = to.y();
      p.z[at] = model.compatible() ? to.z() : terrain.height(position);
      refresh_cell_positions(model, state, work, at, at + 1);
    };
    work.cell_positions.resize(p.size());
    work.thickness.push_back(work.thickness[i]);
    if (state.ground && model.compatible())  // AvaFrame counts the masses of both halves
      for (std::vector<double>* masses : {&work.entrained, &work.detrained})
        if (!masses->empty()) masses->push_back((*masses)[i]);
    put(i, x - along, behind);
    put(p.size() - 1, x + along, ahead);
  }
  work.no_particle_splits = p.size() == before && state.erodible.empty();
  if (p.size() == before) return;
  number_new(state, work, before);
  work.bond_lists.update(state.bonds, p.size());
}

void sort_by_cell(State& state, Workspace& work) {
  const std::vector<std::uint32_t>& order = work.cells.order();
  AlignedVector<double> scratch(order.size());
  work.new_indices.resize(order.size());
  // Nothing from here on allocates.
  state.particles.for_each_array(
      [&](const char*, auto& array) { reorder(order, scratch, work.threads, array); });
  for (std::size_t e = 0; e < order.size(); ++e) work.new_indices[order[e]] = std::uint32_t(e);
  for (auto* ends : {&state.bonds.first, &state.bonds.second})
    parallel_for_static(std::ptrdiff_t(ends->size()), work.threads,
                        [&](std::ptrdiff_t b) { (*ends)[b] = work.new_indices[(*ends)[b]]; });
}

}  // namespace snowshed::methods::slide
