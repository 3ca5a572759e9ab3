// The fields of events in the memory of a device: where blocks of nodes of several events lie at
// the same position, and the contacts there. Without such positions it holds nothing.
#pragma once

#include "snowshed/methods/mpm/gpu/device_array.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"
#include "snowshed/methods/mpm/model.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm::gpu {

class DeviceEvents {
 public:
  using HostState = State<float, 3>;

  DeviceEvents(snowshed::gpu::Device& device, const Model<float, 3>& model);

  /// Whether the snow of several events is so near that it may meet before the next sort.
  bool meet() const { return pairs_.size() > 0; }
  /// Follows a change of the layout, and takes over the stored impulses of the host's contacts.
  void connect(const HostState&);
  /// Follows a change of the sleep.
  void follow_sleep(const HostState&);
  /// Brings the host's contacts up to date.
  void download(HostState&) const;

  /// Finds the radii of the particles, which have been sorted, and then all contacts.
  void find_all_contacts(const ParticleLaunch&, std::size_t particles, const Constants&);
  /// Queues the search for contacts in a step. A pair is searched once its snow has moved far
  /// enough.
  void search(const ParticleLaunch&, const Control*, const Constants&) const;
  /// Queues the steps of the nodes of these positions.
  void launch_step(const GridArrays&, const ContactArrays&, const ForceArrays&, const EnergyArrays&,
                   Control*, const Constants&) const;

  /// The blocks of nodes that take part in a step and lie at no such position.
  const DeviceArray<std::int32_t>& lone_blocks() const { return lone_; }
  std::size_t bytes() const;

 private:
  EventArrays view() const;
  void launch_search(ParticleLaunch, const DeviceArray<std::int32_t>& pairs, const Control*,
                     const Constants&) const;

  snowshed::gpu::Device& device_;
  double radius_share_;
  float friction_;
  std::vector<EventPair> host_pairs_;
  DeviceArray<std::int32_t> first_block_, blocks_, first_pair_, nodes_around_, particles_around_;
  DeviceArray<EventPair> pairs_;
  DeviceArray<std::int32_t> lone_, active_overlaps_, active_pairs_, all_pairs_;
  DeviceArray<EventNode> nodes_;
  DeviceArray<double> travel_;
  DeviceArray<float> radius_;
  DeviceArray<InitialSnow> snows_;
};

}  // namespace snowshed::methods::mpm::gpu
