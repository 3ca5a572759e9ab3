// Facts of the core about this machine.
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "bindings.hpp"
#include "snowshed/core/available_cores.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/memory.hpp"
#include "snowshed/gpu/card.hpp"
#include "snowshed/gpu/runtime_compiler.hpp"

namespace snowshed {
namespace {

/// The folders of packages in which NVIDIA's runtime compiler may lie; Python is asked when a card
/// is.
gpu::Folders compiler_folders() {
  const pybind11::gil_scoped_acquire lock;
  const auto module = pybind11::module_::import("snowshed.base.compiler_folders");
  const auto names = module.attr("compiler_folders")().cast<std::vector<std::string>>();
  return {names.begin(), names.end()};
}

}  // namespace

void bind_machine(pybind11::module_& m) {
  gpu::set_compiler_folders(&compiler_folders);
  m.def(
      "available_cores", &available_cores,
      "The number of cores that this process may use, by its affinity and its container's quota.");
  m.def("available_memory_bytes", &available_memory_bytes,
        "Memory that is available now without swapping.");
  m.def("graphics_cards", &gpu::count_cards,
        "The number of NVIDIA's cards that this process may use; 0 without a driver.");
  m.def("kernel_variant", &kernel_variant_name, "Instruction set of the kernels.");
  m.def("slow_kernels_note", &slow_kernels_note,
        "A sentence on the cost of kernels without AVX2, if these are used; otherwise empty.");
}

}  // namespace snowshed
