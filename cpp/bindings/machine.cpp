// Facts of the core about this machine.
#include "bindings.hpp"
#include "snowshed/core/available_cores.hpp"
#include "snowshed/core/kernel_variant.hpp"
#include "snowshed/core/memory.hpp"

namespace snowshed {

void bind_machine(pybind11::module_& m) {
  m.def("available_cores", &available_cores,
        "The number of cores that this process may use, by its affinity and its container's quota.");
  m.def("available_memory_bytes", &available_memory_bytes,
        "Memory that is available now without swapping.");
  m.def("slow_kernels_note", &slow_kernels_note,
        "A sentence on the cost of kernels without AVX2, if these are used; otherwise empty.");
}

}  // namespace snowshed
