#include "snowshed/methods/mpm/touch.hpp"

#include <algorithm>
#include <cmath>

#include "snowshed/core/parallel.hpp"
#include "snowshed/geometry/bounds.hpp"

namespace snowshed::methods::mpm {
namespace {

static_assert(block_nodes<2> == 64 && block_nodes<3> == 64,
              "a block's nodes are the bits of a word");

/// The nodes of a block that lie in a box of nodes.
template <int D>
std::uint64_t nodes_in_box(const int (&begin)[D], int size) {
  constexpr int B = block_edge<D>;
  int low[D], high[D];
  for (int d = 0; d < D; ++d) {
    low[d] = std::max(begin[d], 0);
    high[d] = std::min(begin[d] + size, B);
    if (low[d] >= high[d]) return 0;
  }
  const std::uint64_t row = ((std::uint64_t(1) << (high[D - 1] - low[D - 1])) - 1) << low[D - 1];
  std::uint64_t nodes = 0;
  for (int i = low[0]; i < high[0]; ++i) {
    if constexpr (D == 2)
      nodes |= row << (i * B);
    else
      for (int j = low[1]; j < high[1]; ++j) nodes |= row << ((i * B + j) * B);
  }
  return nodes;
}

/// A node within a thin plate belongs to the side on which it lies, unless this many times more
/// particles touch the other side. The few particles on the node's side have then crossed the
/// middle.
constexpr int min_majority = 10;
/// Faces are merged if the cosine between their normals is larger than this.
constexpr double cosine_of_one_face = 0.99;

/// Flags of the blocks of nodes that the particles of the flagged blocks reach.
template <int D>
std::vector<std::uint8_t> reached_by(const BlockLayout<D>& layout,
                                     const std::vector<std::int32_t>& particle_blocks,
                                     const std::vector<std::uint8_t>& flags) {
  std::vector<std::uint8_t> reached(layout.grid_blocks.size(), 0);
  for (std::size_t k = 0; k < flags.size(); ++k)
    if (flags[k])
      for (const std::int32_t g : layout.around_particles[particle_blocks[k]]) reached[g] = 1;
  return reached;
}

template <class T, std::size_t D, class Vector>
T cosine(const std::array<T, D>& a, const Vector& b) {
  T sum = 0;
  for (std::size_t d = 0; d < D; ++d) sum += a[d] * b[d];
  return sum;
}

}  // namespace

template <class T, int D>
void Touch<T, D>::forget(const Model<T, D>& model, const State<T, D>& state) {
  measured_ = false;
  travel_ = 0;
  largest_radius_ = state.largest_contact_radius(model);
  blocks_.resize(state.layout.particle_blocks.size());
  next_.assign(state.particles.size(), 0.0);
  radius_.assign(state.particles.size(), -1.0);
}

template <class T, int D>
std::vector<std::int32_t> Touch<T, D>::due_blocks(const Model<T, D>& model,
                                                  const State<T, D>& state) const {
  const bool all = all_due(model);
  std::vector<std::int32_t> due;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (all || (travel_ >= blocks_[b].next && !state.sleep.states()[b].asleep))
      due.push_back(std::int32_t(b));
  return due;
}

template <class T, int D>
double Touch<T, D>::reserve(const State<T, D>& state) const {
  double next = geometry::infinity;
  for (const std::int32_t b : state.sleep.awake())
    next = std::min(next, blocks_[std::size_t(b)].next);
  return next - travel_;
}

template <class T, int D>
void Touch<T, D>::measure(const Model<T, D>& model, State<T, D>& state,
                          const std::vector<std::int32_t>& blocks, int threads) {
  if (blocks.empty()) return;
  const bool all = all_due(model);
  measured_ = false;  // stays false if this throws
  std::vector<std::uint8_t> changed(blocks.size());
  parallel_for_dynamic(std::ptrdiff_t(blocks.size()), threads, 4, [&](std::ptrdiff_t i) {
    changed[std::size_t(i)] = measure(model, state, blocks[std::size_t(i)]) || all;
  });
  const std::vector<std::uint8_t> reached = reached_by(state.layout, blocks, changed);
  parallel_for_dynamic(std::ptrdiff_t(reached.size()), threads, 16, [&](std::ptrdiff_t g) {
    if (reached[std::size_t(g)]) mark(model, state, std::int32_t(g));
  });
  measured_ = true;
}

/// The particles of a block that may touch an obstacle.
template <class T, int D>
std::vector<std::int32_t> Touch<T, D>::due_particles(const Model<T, D>& model,
                                                     const State<T, D>& state,
                                                     std::int32_t b) const {
  const bool all = model.boundary.any_motion();
  std::vector<std::int32_t> due;
  for (std::int32_t i = state.layout.first[b]; i < state.layout.first[b + 1]; ++i)
    if (all || next_[std::size_t(i)] <= travel_) due.push_back(i);
  return due;
}

template <class T, int D>
double Touch<T, D>::radius(const Model<T, D>& model, const State<T, D>& state, std::int32_t i) {
  double& radius = radius_[std::size_t(i)];
  if (radius < 0) radius = state.contact_radius(model, std::size_t(i));
  return radius;
}

/// Finds the particles of a block that touch an obstacle. Returns whether they are others than
/// before, or touch elsewhere.
template <class T, int D>
bool Touch<T, D>::measure(const Model<T, D>& model, const State<T, D>& state, std::int32_t b) {
  const Settings& n = model.options.settings;
  const BlockKey key = state.layout.particle_blocks[b];
  // Reach around the block's centre, including the cell by which particles may stray.
  const double reach = (0.5 * block_edge<D> + 1) * std::sqrt(double(D)) * n.dx;
  VecD<D> center;
  for (int d = 0; d < D; ++d)
    center[d] = ((block_coord<D>(key)[d] + 0.5) * block_edge<D> + base_offset(n.basis)) * n.dx;
  const std::vector<std::int32_t> due = due_particles(model, state, b);
  for (const std::int32_t i : due) next_[std::size_t(i)] = geometry::infinity;
  std::vector<TouchingParticle> touching;
  for (std::int32_t o = 0; o < std::int32_t(model.boundary.size()); ++o) {
    const auto surface = model.boundary.surface(o, state.totals.time);
    const double around = surface.distance(embed(center)) - reach - largest_radius_;
    for (const std::int32_t i : due) {
      double gap = around;
      if (around <= 0) {
        const VecD<D> x = position_of(state.particles, std::size_t(i), key, n.dx, n.basis);
        const double distance = surface.distance(embed(x));
        gap = distance - largest_radius_;
        if (gap <= 0) gap = distance - radius(model, state, i);
        if (gap <= 0) {
          TouchingParticle particle{i, o, {}, {}};
          const VecD<D> normal = surface.normal(embed(x));
          for (int d = 0; d < D; ++d) {
            particle.lowest[d] = int(std::floor(state.particles.cell[d][i]));
            particle.normal[d] = T(normal[d]);
          }
          touching.push_back(particle);
          gap = 0;
        }
      }
      next_[std::size_t(i)] = std::min(next_[std::size_t(i)], travel_ + gap);
    }
  }
  Block& block = blocks_[b];
  block.next = geometry::infinity;
  for (std::int32_t i = state.layout.first[b]; i < state.layout.first[b + 1]; ++i)
    block.next = std::min(block.next, next_[std::size_t(i)]);
  // A particle may cease to touch before the next measurement. The short delay does not matter.
  block.next = std::max(block.next, travel_ + contact_tolerance * n.dx);
  const bool changed = touching != block.touching_particles;
  block.touching_particles = std::move(touching);
  return changed;
}

template <class T, int D>
void Touch<T, D>::mark(const Model<T, D>& model, State<T, D>& state, std::int32_t g) const {
  Contact<T>* contacts = state.contacts.of_block(std::size_t(g));
  const int count = state.contacts.count(std::size_t(g));
  std::int32_t obstacle = -1;
  std::vector<Face> touched;
  for (int k = 0; k < count; ++k) {
    Contact<T>& c = contacts[k];
    if (c.obstacle != obstacle) {  // contacts are in the order of obstacles
      obstacle = c.obstacle;
      touched = faces(state.layout, g, obstacle);
    }
    VecD<D> near = VecD<D>::Zero(), far = VecD<D>::Zero();  // sums of normals over particles
    std::int32_t at_near = 0, at_far = 0;
    for (const Face& face : touched) {
      if (!(face.nodes >> c.node & 1)) continue;
      const bool is_near = cosine(face.normal, c.outward) >= T(0);
      (is_near ? at_near : at_far) += face.particles;
      for (int d = 0; d < D; ++d)
        (is_near ? near : far)[d] += face.particles * double(face.normal[d]);
    }
    const VecD<D> normal = at_far > min_majority * at_near ? far : near;
    const double length = normal.norm();
    c.acts = length > 1e-6;
    if (!c.acts) continue;
    for (int d = 0; d < D; ++d) c.normal[d] = T(normal[d] / length);
    c.release = release(model.boundary.laws()[obstacle].condition, normal[D - 1]);
  }
}

template <class T, int D>
std::vector<typename Touch<T, D>::Face> Touch<T, D>::faces(const BlockLayout<D>& layout,
                                                           std::int32_t g,
                                                           std::int32_t obstacle) const {
  const BlockCoord<D> block = block_coord<D>(layout.grid_blocks[g]);
  std::vector<Face> touched;
  for (const std::int32_t b : layout.around_nodes[g]) {
    if (b < 0) continue;
    const BlockCoord<D> from = block_coord<D>(layout.particle_blocks[b]);
    for (const TouchingParticle& t : blocks_[b].touching_particles) {
      if (t.obstacle != obstacle) continue;
      int begin[D];
      for (int d = 0; d < D; ++d) begin[d] = t.lowest[d] + (from[d] - block[d]) * block_edge<D>;
      const std::uint64_t nodes = nodes_in_box<D>(begin, support_);
      if (nodes == 0) continue;
      auto face = std::find_if(touched.begin(), touched.end(), [&](const Face& f) {
        return cosine(f.normal, t.normal) > T(cosine_of_one_face);
      });
      if (face == touched.end()) {
        touched.push_back({t.normal, 0, 0});
        face = touched.end() - 1;
      }
      face->nodes |= nodes;
      ++face->particles;
    }
  }
  return touched;
}

template class Touch<float, 2>;
template class Touch<float, 3>;
template class Touch<double, 2>;
template class Touch<double, 3>;

}  // namespace snowshed::methods::mpm
