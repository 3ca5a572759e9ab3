#include "snowshed/gpu/card.hpp"

#include <utility>

#include "snowshed/gpu/cuda_device.hpp"
#include "snowshed/gpu/machine_code.hpp"

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

}  // namespace

Card find_card() { return find_card(std::make_shared<const CudaDriver>()); }

Card find_card(std::shared_ptr<const CudaDriver> driver) {
  Card card{std::move(driver), nullptr, 0, "", 0};
  card.driver->check(card.driver->DeviceGet(&card.number, 0), "finding it");
  card.name = name_of(*card.driver, card.number);
  card.compiler = std::make_shared<const RuntimeCompiler>(open_compiler(card.driver->cuda_major()));
  card.architecture =
      card.compiler->architecture_for(compute_capability(*card.driver, card.number));
  return card;
}

std::unique_ptr<Device> open_device(const Card& card, const KernelProgram& program) {
  const std::string code = machine_code(*card.compiler, program, card.architecture);
  return std::make_unique<CudaDevice>(card.driver, card.number, card.name, code);
}

}  // namespace snowshed::gpu
