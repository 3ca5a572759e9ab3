#include "snowshed/methods/mpm/device_choice.hpp"

#include "snowshed/core/errors.hpp"
#include "snowshed/core/message_format.hpp"
#include "snowshed/gpu/card.hpp"
#include "snowshed/gpu/unavailable.hpp"
#include "snowshed/methods/mpm/gpu_support.hpp"

namespace snowshed::methods::mpm {
namespace {

std::string gigabytes(double bytes) { return show_briefly(bytes / 1e9) + " GB"; }

std::shared_ptr<snowshed::gpu::Device> open_card(const Options& options, double particles) {
  const snowshed::gpu::Card card = snowshed::gpu::find_card();
  require_supported_on_gpu(options);
  std::shared_ptr<snowshed::gpu::Device> device =
      snowshed::gpu::open_device(card, gpu_kernels(options.energy));
  require_memory(*device, options, particles);
  return device;
}

const char* const untried =
    "computed on a graphics card, whose kernels had run on an emulated card only when this version "
    "was made: compare with a run on the processor (numerics.device \"cpu\")";

DeviceChoice fall_back(const std::string& reason) {
  return {nullptr, "device \"auto\": computed on the processor: " + reason};
}

}  // namespace

void require_memory(const snowshed::gpu::Device& card, const Options& options, double particles) {
  const double needed = bytes_on_gpu(options.settings, options.energy, particles),
               free = double(card.free_bytes());
  if (needed > free)
    throw snowshed::gpu::Unavailable(show_rounded(particles) + " particles need " +
                                     gigabytes(needed) + " on the card; free on the " +
                                     card.name() + " are " + gigabytes(free) +
                                     "; give fewer particles or a larger dx");
}

DeviceChoice choose_device(const Options& options, double particles) {
  const DeviceSetting asked = options.settings.device;
  if (asked == DeviceSetting::cpu) return {};
  try {
    return {open_card(options, particles), untried};
  } catch (const InputError& error) {
    if (asked == DeviceSetting::automatic) return fall_back(error.what());
    if (!error.where().empty()) throw;
    throw InputError("/numerics/device", error.what());
  } catch (const SimulationError& error) {  // the card is there, but does not work
    if (asked == DeviceSetting::automatic) return fall_back(error.what());
    throw InputError("/numerics/device", error.what());
  }
}

}  // namespace snowshed::methods::mpm
