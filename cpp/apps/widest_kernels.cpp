// Prints the widest instruction set of the kernels that this machine runs.
#define SNOWSHED_HAS_KERNELS_avx2
#define SNOWSHED_HAS_KERNELS_avx512
#include <cstdio>

#include "snowshed/core/kernel_variant.cpp"

int main() {
  unsetenv("SNOWSHED_KERNELS");
  std::fputs(snowshed::kernel_variant(), stdout);
}
