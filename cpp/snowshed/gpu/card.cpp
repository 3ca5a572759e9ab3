#include "snowshed/gpu/card.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "snowshed/gpu/cuda_device.hpp"
#include "snowshed/gpu/machine_code.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

std::string name_of(const CudaDriver& driver, cuda::DeviceNumber number) {
  char name[256] = "";
  driver.check(driver.DeviceGetName(name, int(sizeof name) - 1, number), "asking for its name");
  return name;
}

int attribute(const CudaDriver& driver, cuda::DeviceNumber number, int which) {
  int value = 0;
  driver.check(driver.DeviceGetAttribute(&value, which, number), "asking for its properties");
  return value;
}

int compute_capability(const CudaDriver& driver, cuda::DeviceNumber number) {
  return 10 * attribute(driver, number, cuda::compute_capability_major) +
         attribute(driver, number, cuda::compute_capability_minor);
}

cuda::DeviceNumber device_number(const CudaDriver& driver, int ordinal) {
  cuda::DeviceNumber number = 0;
  driver.check(driver.DeviceGet(&number, ordinal), "finding it");
  return number;
}

/// The slot of each card, which is the same in all processes. Its colons become dashes, because it
/// names a folder.
std::vector<std::string> slots(const CudaDriver& driver) {
  std::vector<std::string> slots;
  for (int ordinal = 0; ordinal < driver.cards(); ++ordinal) {
    char slot[64] = "";
    driver.check(
        driver.DeviceGetPCIBusId(slot, int(sizeof slot) - 1, device_number(driver, ordinal)),
        "asking for its slot");
    slots.emplace_back(slot);
    std::replace(slots.back().begin(), slots.back().end(), ':', '-');
  }
  return slots;
}

}  // namespace

int count_cards() {
  try {
    return CudaDriver().cards();
  } catch (const Unavailable&) {
    return 0;
  }
}

Card find_card() { return find_card(std::make_shared<const CudaDriver>()); }

Card find_card(std::shared_ptr<const CudaDriver> driver) {
  Card card{std::move(driver), nullptr, {}, 0, "", 0};
  card.claimed = claim_card(slots(*card.driver));
  card.number = device_number(*card.driver, card.claimed.number);
  card.name = name_of(*card.driver, card.number);
  card.compiler = std::make_shared<const RuntimeCompiler>(open_compiler(card.driver->cuda_major()));
  card.architecture =
      card.compiler->architecture_for(compute_capability(*card.driver, card.number));
  return card;
}

std::unique_ptr<Device> open_device(const Card& card, const KernelProgram& program) {
  const std::string code = machine_code(*card.compiler, program, card.architecture);
  return std::make_unique<CudaDevice>(card.driver, card.number, card.name, code,
                                      card.claimed.claim);
}

}  // namespace snowshed::gpu
