// Picks, once, the widest instruction set that both the build and the machine have.
#include "snowshed/core/kernel_variant.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "snowshed/core/errors.hpp"

namespace snowshed {
namespace {

bool build_has(KernelVariant variant) {
#ifdef SNOWSHED_HAS_KERNELS_avx512
  if (variant == KernelVariant::avx512) return true;
#endif
#ifdef SNOWSHED_HAS_KERNELS_avx2
  if (variant == KernelVariant::avx2) return true;
#endif
  return variant == KernelVariant::baseline;
}

bool is_supported(KernelVariant variant) { return build_has(variant) && machine_has(variant); }

std::vector<KernelVariant> supported_variants() {
  std::vector<KernelVariant> supported;
  std::copy_if(std::begin(all_variants), std::end(all_variants), std::back_inserter(supported),
               is_supported);
  return supported;
}

template <class Variants>
std::string list_of(const Variants& variants) {
  std::string list;
  for (const KernelVariant v : variants)
    list += (list.empty() ? "" : ", ") + std::string(name_of(v));
  return list;
}

/// The widest variant that runs here, or the one that the user asks for.
KernelVariant select_variant() {
  const std::vector<KernelVariant> supported = supported_variants();
  const char* forced = std::getenv("SNOWSHED_KERNELS");
  if (!forced || !*forced) return supported.back();
  for (const KernelVariant v : supported)
    if (std::strcmp(forced, name_of(v)) == 0) return v;
  throw InputError("SNOWSHED_KERNELS", "is \"" + std::string(forced) +
                                           "\"; allowed: " + list_of(all_variants) +
                                           "; this machine can run: " + list_of(supported));
}

}  // namespace

KernelVariant kernel_variant() {
  static const KernelVariant chosen = select_variant();
  return chosen;
}

const char* kernel_variant_name() { return name_of(kernel_variant()); }

const char* slow_kernels_note() {
  const KernelVariant chosen = kernel_variant();
  if (chosen == KernelVariant::avx2 && machine_has(KernelVariant::avx512) &&
      !build_has(KernelVariant::avx512))
    return "this build has no AVX-512 kernels, which would save up to a fifth of the time on this "
           "processor (make build KERNELS=all)";
  if (chosen != KernelVariant::baseline) return "";
  if (machine_has(KernelVariant::avx2) && supported_variants().size() == 1)
    return "this build has no AVX2 kernels: runs take two to five times as long as necessary (make "
           "build KERNELS=all)";
  return "this processor has no AVX2: runs take two to five times as long as on processors since "
         "2013";
}

}  // namespace snowshed
