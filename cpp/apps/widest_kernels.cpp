// Prints the widest instruction set of the kernels that this machine runs.
#include <cstdio>

#include "snowshed/core/instruction_sets.hpp"

int main() {
  snowshed::KernelVariant widest = snowshed::KernelVariant::baseline;
  for (const snowshed::KernelVariant variant : snowshed::all_variants)
    if (snowshed::machine_has(variant)) widest = variant;
  std::fputs(snowshed::name_of(widest), stdout);
}
