#include "snowshed/methods/mpm/gpu_support.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"
#include "snowshed/gpu/device.hpp"

namespace snowshed::methods::mpm {

void require_supported_on_gpu(const Options& o) {
  std::vector<std::string> parts;
  if (o.dimension == 2) parts.push_back("two dimensions (the blocks of its threads are cubes)");
  if (o.settings.precision == Precision::float64)
    parts.push_back("double precision (cards for graphics compute it 32 to 64 times slower)");
  if (o.laws.any()) parts.push_back("laws of the user (they are code for a processor)");
  // Until this version has kernels, no scene gets past here.
  parts.push_back("the steps of this method (this version has no kernels for cards yet)");
  std::string list;
  for (const std::string& part : parts) list += (list.empty() ? "" : "; ") + part;
  throw InputError("", "not supported on a graphics card: " + list);
}

double bytes_on_gpu(double particles) {
  constexpr double state_and_id = 60, sort = 88, grid = 88;  // grid: 21 to 88
  return particles * (state_and_id + sort + grid);
}

gpu::KernelProgram gpu_kernels(const Options&) {
  throw std::logic_error("no kernels for graphics cards");
}

std::unique_ptr<Solver> make_gpu_solver(Options, std::shared_ptr<gpu::Device>) {
  throw std::logic_error("no solver for graphics cards");
}

}  // namespace snowshed::methods::mpm
