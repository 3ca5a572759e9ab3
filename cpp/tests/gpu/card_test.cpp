#include "snowshed/gpu/card.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "gpu/cuda_testing.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

using io::message_of;

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

TEST(Card, WithoutADriverTheErrorSaysWhatToInstall) {
  const Variable variable("SNOWSHED_CUDA", "/nonexistent/libcuda.so.1");
  const std::string message = message_of<Unavailable>([] { find_card(); });
  EXPECT_TRUE(begins_with(message, "no NVIDIA driver: /nonexistent/libcuda.so.1: ")) << message;
  EXPECT_NE(message.find("install the driver of the card"), std::string::npos) << message;
}

TEST(Card, ALibraryThatIsNoDriverIsNamedWithTheMissingFunction) {
  const std::string message = message_of<Unavailable>([] { CudaDriver driver("libm.so.6"); });
  EXPECT_EQ(message, "libm.so.6 has no function cuInit");
}

TEST(Card, ADriverThatFindsNoCardSaysSo) {
  const FakeCuda fake;
  fake.fail("cuInit", 100);
  EXPECT_TRUE(begins_with(message_of<Unavailable>([&] { fake.driver(); }), "no NVIDIA card: "));
}

TEST(Card, ADriverThatDoesNotStartIsQuoted) {
  const FakeCuda fake;
  fake.fail("cuInit", 803);
  const std::string message = message_of<Unavailable>([&] { fake.driver(); });
  EXPECT_TRUE(begins_with(message,
                          "the NVIDIA driver does not start: CUDA_ERROR_LAUNCH_FAILED (as the "
                          "test wants)"))
      << message;
}

TEST(Card, WithoutACompilerTheErrorHasTheCommandThatInstallsIt) {
  const FakeCuda fake;
  const Variable variable("SNOWSHED_NVRTC", "");
  set_compiler_folders(nullptr);
  try {
    find_card(fake.driver());
    GTEST_SKIP() << "the system has NVIDIA's runtime compiler";
  } catch (const Unavailable& error) {
    EXPECT_NE(std::string(error.what()).find("pip install \"snowshed[gpu]\""), std::string::npos)
        << error.what();
  }
}

TEST(Card, TheVariableForTheCompilerComesFirst) {
  const Variable variable("SNOWSHED_NVRTC", "/nonexistent/libnvrtc.so");
  const std::string message = message_of<Unavailable>([] { open_compiler(13); });
  EXPECT_TRUE(begins_with(message, "SNOWSHED_NVRTC: /nonexistent/libnvrtc.so: ")) << message;
}

TEST(Card, RefusesACompilerThatIsNewerThanTheDriver) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const Variable variable("SNOWSHED_NVRTC", nullptr);
  const std::string message =
      message_of<Unavailable>([&] { open_compiler(compiler->major() - 1); });
  EXPECT_NE(message.find("makes code that this driver cannot load"), std::string::npos) << message;
  EXPECT_NE(message.find("update the driver"), std::string::npos) << message;
}

TEST(Card, OpensWithItsNameAndTheKernelsOfTheProgram) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const FakeCuda fake;
  const Card card = find_card(fake.driver());
  EXPECT_EQ(card.name, "Fake card");
  EXPECT_EQ(card.architecture, 90);
  const auto device = open_device(card, {"one.cu", "extern \"C\" __global__ void add_one() {}"});
  EXPECT_EQ(device->name(), "Fake card");
}

/// The card of this machine, if it has one: the only test that needs it.
TEST(Card, ARealOneRunsAKernelOfThisProgram) {
  const KernelProgram program{"add_one.cu", R"(
extern "C" __global__ void add_one(int* values, int count) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) ++values[i];
})"};
  std::unique_ptr<Device> device;
  try {
    set_compiler_folders(&package_folders);
    device = open_device(find_card(), program);
  } catch (const Unavailable& error) {
    GTEST_SKIP() << error.what();
  }
  int count = 1000;
  std::vector<int> values(std::size_t(count), 0);
  const std::size_t bytes = sizeof(int) * values.size();
  Address counts = device->allocate(bytes);
  device->clear(counts, bytes);
  void* arguments[] = {&counts, &count};
  for (int i = 0; i < 3; ++i) device->launch("add_one", {8, 128}, arguments);
  device->download(values.data(), counts, bytes);
  EXPECT_EQ(values, std::vector<int>(std::size_t(count), 3));
  device->free(counts);
  EXPECT_THROW(device->allocate(std::size_t(1) << 50), SimulationError);
}

}  // namespace
}  // namespace snowshed::gpu
