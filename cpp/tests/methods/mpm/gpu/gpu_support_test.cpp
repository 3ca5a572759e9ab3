#include "snowshed/methods/mpm/gpu_support.hpp"

#include <gtest/gtest.h>

#include "snowshed/core/errors.hpp"

namespace snowshed::methods::mpm::gpu {
namespace {

std::vector<std::string> paths(const Options& options) {
  std::vector<std::string> all;
  for (const Unsupported& u : unsupported_on_gpu(options)) all.push_back(u.path);
  return all;
}

TEST(GpuSupport, BothSchemesRunOnACard) {
  Options objective;
  objective.settings.adopt(Scheme::objective);
  for (const Options& o : {Options(), objective}) EXPECT_NO_THROW(require_supported_on_gpu(o));
}

TEST(GpuSupport, NamesEachSetting) {
  using Change = void (*)(Options&);
  const std::vector<std::pair<Change, std::string>> changes{
      {[](Options& o) { o.dimension = 2; }, "/dimension"},
      {[](Options& o) { o.settings.precision = Precision::float64; }, "/numerics/precision"},
      {[](Options& o) { o.settings.basis = Basis::cubic; }, "/numerics/basis"},
      {[](Options& o) {
         o.laws.body_force = [](std::int64_t, const double*, const double*, const double*, double,
                                double*, double*, double*) {};
       },
       "/"}};
  for (const auto& [change, path] : changes) {
    Options o;
    change(o);
    EXPECT_EQ(paths(o), std::vector<std::string>{path});
  }
}

TEST(GpuSupport, IsRefusedWithAllReasons) {
  Options o;
  o.settings.basis = Basis::cubic;
  o.settings.precision = Precision::float64;
  try {
    require_supported_on_gpu(o);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "/numerics/precision");
    for (const std::string& path : paths(o))
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << path;
    EXPECT_NE(std::string(error.what()).find("numerics.device \"cpu\""), std::string::npos);
  }
}

}  // namespace
}  // namespace snowshed::methods::mpm::gpu
