// The coarse grid over which velocities are averaged, in the memory of a device.
#pragma once

#include <optional>

#include "snowshed/methods/mpm/average_layout.hpp"
#include "snowshed/methods/mpm/gpu/device_array.hpp"
#include "snowshed/methods/mpm/gpu/views.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/mpm/state.hpp"

namespace snowshed::methods::mpm::gpu {

class DeviceAverage {
 public:
  /// Without a damping length there is no coarse grid.
  DeviceAverage(snowshed::gpu::Device& device, const Settings& settings);

  bool exists() const { return layout_.has_value(); }
  double share_of_length() const { return layout_ ? layout_->share_of_length() : 0.0; }
  /// Follows a change of the layout. All sums become zero.
  void connect(const State<float, 3>&);
  /// Sets the sums of sleeping snow to zero.
  void clear_asleep() { asleep_.clear(); }
  unsigned coarse_blocks() const { return unsigned(mean_.size() / nodes_of_block); }
  AverageArrays view() const;
  std::size_t bytes() const;

 private:
  std::optional<AverageLayout<3>> layout_;
  DeviceArray<AverageBlock> blocks_;
  DeviceArray<std::int32_t> around_;
  DeviceArray<unsigned long long> integers_, asleep_;
  DeviceArray<Quad> mean_;
};

}  // namespace snowshed::methods::mpm::gpu
