#include "snowshed/methods/mpm/device_choice.hpp"

#include <gtest/gtest.h>

#include "gpu/cuda_testing.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/gpu/cuda_device.hpp"
#include "snowshed/methods/mpm/gpu_support.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::methods::mpm {
namespace {

using gpu::FakeCuda;
using gpu::Variable;
using io::message_of;

Options options_on(DeviceSetting device) {
  Options options;
  options.settings.device = device;
  return options;
}

TEST(DeviceChoice, TheProcessorIsTheDefaultAndTouchesNoDriver) {
  const FakeCuda fake;
  const Variable driver("SNOWSHED_CUDA", SNOWSHED_FAKE_CUDA);
  const DeviceChoice choice = choose_device(Options(), 1e6);
  EXPECT_FALSE(choice.is_card());
  EXPECT_EQ(choice.name(), "cpu");
  EXPECT_EQ(choice.note, "");
  EXPECT_STREQ(fake.calls(), "");
}

TEST(DeviceChoice, ACardThatIsMissingIsTheErrorOfTheSetting) {
  const Variable driver("SNOWSHED_CUDA", "/nonexistent/libcuda.so.1");
  const std::string message =
      message_of<InputError>([] { choose_device(options_on(DeviceSetting::gpu), 1); });
  EXPECT_EQ(message.find("/numerics/device: no NVIDIA driver: "), 0u) << message;
}

TEST(DeviceChoice, TheAutomaticOneIsTheProcessorWithTheReason) {
  const Variable driver("SNOWSHED_CUDA", "/nonexistent/libcuda.so.1");
  const DeviceChoice choice = choose_device(options_on(DeviceSetting::automatic), 1);
  EXPECT_EQ(choice.name(), "cpu");
  EXPECT_EQ(choice.note.find("device \"auto\": computed on the processor: no NVIDIA driver: "), 0u)
      << choice.note;
}

TEST(DeviceChoice, ACardThatDoesNotWorkIsTheErrorOrTheReason) {
  const FakeCuda fake;
  const Variable driver("SNOWSHED_CUDA", SNOWSHED_FAKE_CUDA);
  fake.fail("cuDeviceGet", 101);
  EXPECT_THROW(choose_device(options_on(DeviceSetting::gpu), 1), InputError);
  const DeviceChoice choice = choose_device(options_on(DeviceSetting::automatic), 1);
  EXPECT_NE(choice.note.find("graphics card: finding it failed"), std::string::npos) << choice.note;
}

TEST(DeviceChoice, TheErrorListsAllThatACardDoesNotCompute) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const FakeCuda fake;
  const Variable driver("SNOWSHED_CUDA", SNOWSHED_FAKE_CUDA);
  Options options = options_on(DeviceSetting::gpu);
  options.dimension = 2;
  options.settings.precision = Precision::float64;
  const std::string message = message_of<InputError>([&] { choose_device(options, 1); });
  EXPECT_EQ(message.find("/dimension: is 2, which a graphics card does not support"), 0u)
      << message;
  EXPECT_NE(message.find("/numerics/precision is \"double\""), std::string::npos) << message;
  EXPECT_EQ(fake.leaks(), 0u);
}

TEST(DeviceChoice, ParticlesThatDoNotFitAreRefusedWithBothNumbers) {
  const FakeCuda fake;  // with 1 MB
  const snowshed::gpu::CudaDevice card(fake.driver(), 0, "Fake card", "machine code");
  EXPECT_NO_THROW(require_memory(card, Options(), 4000));
  EXPECT_EQ(message_of<snowshed::gpu::Unavailable>([&] { require_memory(card, Options(), 1e6); }),
            "1e+06 particles need 0.227 GB on the card; free on the Fake card are 0.001 GB; give "
            "fewer particles or a larger dx");
  Options affine, balance;
  affine.settings.transfer = Transfer::affine_flip;
  EXPECT_EQ(message_of<snowshed::gpu::Unavailable>([&] {
              require_memory(card, affine, 1e6);
            }).find("1e+06 particles need 0.263 GB"),
            0u);
  balance.energy = true;
  EXPECT_EQ(message_of<snowshed::gpu::Unavailable>([&] {
              require_memory(card, balance, 1e6);
            }).find("1e+06 particles need 0.268 GB"),
            0u);
}

TEST(DeviceChoice, TheSolverOnTheProcessorDoesNotPretendToBeOnACard) {
  EXPECT_THROW(make_solver(options_on(DeviceSetting::gpu)), InputError);
  EXPECT_NO_THROW(make_solver(options_on(DeviceSetting::automatic)));
}

TEST(DeviceChoice, ASceneTakesThreadsAndDeviceOfAnother) {
  scene::Scene one, other;
  other.numerics.as<Settings>().threads = 3;
  other.numerics.as<Settings>().device = DeviceSetting::automatic;
  other.numerics.as<Settings>().dx = 0.5;
  const scene::Scene moved = scene::with_machine_of(other, one);
  const Settings& taken = moved.numerics.as<Settings>();
  EXPECT_EQ(taken.threads, 3);
  EXPECT_EQ(taken.device, DeviceSetting::automatic);
  EXPECT_EQ(taken.dx, Settings().dx);
}

}  // namespace
}  // namespace snowshed::methods::mpm
