#include "snowshed/methods/mpm/gpu/device_events.hpp"

#include <algorithm>
#include <numeric>

namespace snowshed::methods::mpm::gpu {
namespace {

using Layout = BlockLayout<3>;
using Around = Layout::Neighbours;

/// Calls f(contact, node of the device) for each node of a pair. The contact names the node.
template <class F>
void for_each_node(const Layout& layout, const std::vector<EventPair>& pairs,
                   std::vector<EventNode>& nodes, const F& f) {
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    EventContact<float> c{};
    c.first = layout.overlap_blocks[std::size_t(pairs[p].first)];
    c.second = layout.overlap_blocks[std::size_t(pairs[p].second)];
    c.first_key = layout.grid_blocks[std::size_t(c.first)];
    c.second_key = layout.grid_blocks[std::size_t(c.second)];
    for (c.node = 0; c.node < nodes_of_block; ++c.node)
      f(c, nodes[p * nodes_of_block + std::size_t(c.node)]);
  }
}

}  // namespace

DeviceEvents::DeviceEvents(snowshed::gpu::Device& device, const Model<float, 3>& model)
    : device_(device),
      radius_share_(model.options.settings.contact_radius),
      friction_(float(model.event_friction())),
      first_block_(device),
      blocks_(device),
      first_pair_(device),
      nodes_around_(device),
      particles_around_(device),
      pairs_(device),
      lone_(device),
      active_overlaps_(device),
      active_pairs_(device),
      all_pairs_(device),
      nodes_(device),
      travel_(device),
      radius_(device),
      snows_(device) {
  if (model.options.settings.fields == Fields::one) return;
  std::vector<InitialSnow> snows;
  for (const Material& snow : model.materials)
    snows.push_back({snow.density, snow.initial_plastic_strain});
  snows_.upload(snows);
}

void DeviceEvents::connect(const HostState& state) {
  const Layout& layout = state.layout;
  host_pairs_.clear();
  std::vector<std::int32_t> first_pair{0};
  for (std::size_t o = 0; o + 1 < layout.overlap_first.size(); ++o) {
    for (std::int32_t a = layout.overlap_first[o]; a < layout.overlap_first[o + 1]; ++a)
      for (std::int32_t b = a + 1; b < layout.overlap_first[o + 1]; ++b)
        host_pairs_.push_back({a, b});
    first_pair.push_back(std::int32_t(host_pairs_.size()));
  }
  pairs_.upload(host_pairs_);
  if (!meet()) return;
  first_block_.upload(layout.overlap_first);
  blocks_.upload(layout.overlap_blocks);
  first_pair_.upload(first_pair);
  std::vector<std::int32_t> nodes, particles, all(host_pairs_.size());
  for (const std::int32_t g : layout.overlap_blocks) {
    const Around of_nodes = layout.nodes_around(g),
                 &of_particles = layout.around_nodes[std::size_t(g)];
    nodes.insert(nodes.end(), of_nodes.begin(), of_nodes.end());
    particles.insert(particles.end(), of_particles.begin(), of_particles.end());
  }
  nodes_around_.upload(nodes);
  particles_around_.upload(particles);
  std::iota(all.begin(), all.end(), 0);
  all_pairs_.upload(all);
  std::vector<EventContact<float>> stored = state.event_contacts;
  std::sort(stored.begin(), stored.end());
  std::vector<EventNode> contacts(host_pairs_.size() * nodes_of_block);
  for_each_node(layout, host_pairs_, contacts, [&](const EventContact<float>& c, EventNode& node) {
    const auto at = std::lower_bound(stored.begin(), stored.end(), c);
    if (at == stored.end() || at->key() != c.key()) return;
    node.impulse = node.next_impulse = at->next_impulse;
  });
  nodes_.upload(contacts);
  travel_.resize(host_pairs_.size());
  travel_.clear();
}

void DeviceEvents::follow_sleep(const HostState& state) {
  if (!meet()) return;
  const Layout& layout = state.layout;
  std::vector<std::int32_t> lone, overlaps, pairs;
  for (const std::int32_t g : state.sleep.active())
    if (!layout.has_overlap[std::size_t(g)]) lone.push_back(g);
  std::int32_t pair = 0;
  for (std::size_t o = 0; o + 1 < layout.overlap_first.size(); ++o) {
    const std::int32_t begin = layout.overlap_first[o], count = layout.overlap_first[o + 1] - begin;
    const bool active = state.sleep.is_active(layout.overlap_blocks[std::size_t(begin)]);
    if (active) overlaps.push_back(std::int32_t(o));
    for (std::int32_t k = 0; k < count * (count - 1) / 2; ++k, ++pair)
      if (active) pairs.push_back(pair);
  }
  lone_.upload(lone);
  active_overlaps_.upload(overlaps);
  active_pairs_.upload(pairs);
}

void DeviceEvents::download(HostState& state) const {
  if (!meet()) return;
  std::vector<EventNode> nodes = nodes_.download();
  state.event_contacts.clear();
  for_each_node(state.layout, host_pairs_, nodes,
                [&](EventContact<float> c, const EventNode& node) {
                  if (!node.touches && !(node.impulse > 0)) return;
                  c.touches = node.touches != 0;
                  std::copy_n(node.normal, 3, c.normal);
                  c.impulse = node.impulse;
                  c.next_impulse = node.next_impulse;
                  state.event_contacts.push_back(c);
                });
}

void DeviceEvents::find_all_contacts(const ParticleLaunch& l, std::size_t particles,
                                     const Constants& constants) {
  if (!meet()) return;
  constexpr unsigned threads = 256;
  radius_.resize(particles);
  launch(device_, "find_radii", {(unsigned(particles) + threads - 1) / threads, threads},
         l.particles, std::int32_t(particles), static_cast<const InitialSnow*>(snows_.data()),
         radius_share_, constants.dx, radius_.data());
  launch_search(l, all_pairs_, nullptr, constants);
}

void DeviceEvents::search(const ParticleLaunch& l, const Control* control,
                          const Constants& constants) const {
  if (meet()) launch_search(l, active_pairs_, control, constants);
}

void DeviceEvents::launch_search(ParticleLaunch l, const DeviceArray<std::int32_t>& pairs,
                                 const Control* control, const Constants& constants) const {
  l.list = pairs.data();
  launch(device_, "find_event_contacts", {unsigned(pairs.size()), particle_threads}, view(), l,
         control, constants);
}

void DeviceEvents::launch_step(const GridArrays& grid, const ContactArrays& contacts,
                               const ForceArrays& forces, const EnergyArrays& energy,
                               Control* control, const Constants& constants) const {
  if (!meet()) return;
  launch(device_, energy.nodes ? "overlap_step_energy" : "overlap_step",
         {unsigned(active_overlaps_.size()), node_threads}, grid, view(),
         static_cast<const std::int32_t*>(active_overlaps_.data()), contacts, forces, energy,
         control, constants);
}

EventArrays DeviceEvents::view() const {
  return {first_block_.data(),  blocks_.data(),
          first_pair_.data(),   pairs_.data(),
          nodes_around_.data(), particles_around_.data(),
          nodes_.data(),        travel_.data(),
          radius_.data(),       friction_};
}

std::size_t DeviceEvents::bytes() const {
  std::size_t sum = 0;
  const auto add = [&](const auto&... arrays) { sum += (std::size_t(0) + ... + arrays.bytes()); };
  add(first_block_, blocks_, first_pair_, nodes_around_, particles_around_, pairs_, lone_,
      active_overlaps_, active_pairs_, all_pairs_, nodes_, travel_, radius_, snows_);
  return sum;
}

}  // namespace snowshed::methods::mpm::gpu
