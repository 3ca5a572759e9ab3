#include "snowshed/gpu/cuda_device.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "gpu/cuda_testing.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::gpu {
namespace {

using io::message_of;

class CudaDeviceTest : public ::testing::Test {
 protected:
  CudaDevice open() const { return CudaDevice(fake.driver(), 0, "Fake card", "machine code"); }
  std::size_t count(const std::string& function) const {
    std::size_t n = 0;
    const std::string calls = fake.calls();
    for (auto at = calls.find(function + " "); at != std::string::npos;
         at = calls.find(function + " ", at + 1))
      ++n;
    return n;
  }

  FakeCuda fake;
};

void add_one(Device& device, Address values, int count, std::size_t shared_bytes = 0) {
  void* arguments[] = {&values, &count};
  device.launch("add_one", {1, 32, shared_bytes}, arguments);
}

TEST_F(CudaDeviceTest, BytesGoToTheCardThroughKernelsAndBack) {
  CudaDevice device = open();
  const std::vector<int> given{1, 2, 3};
  std::vector<int> downloaded(4);
  const Address values = device.allocate(sizeof(int) * 4);
  device.clear(values, sizeof(int) * 4);
  device.upload(values, given.data(), sizeof(int) * given.size());
  add_one(device, values, 4);
  device.download(downloaded.data(), values, sizeof(int) * 4);
  EXPECT_EQ(downloaded, (std::vector<int>{2, 3, 4, 1}));
  device.free(values);
}

TEST_F(CudaDeviceTest, ReleasesAllThatItTookAndLeavesNoContextCurrent) {
  {
    CudaDevice device = open();
    const Address values = device.allocate(8);
    add_one(device, values, 2);
    device.free(values);
  }
  EXPECT_EQ(fake.leaks(), 0u);
  EXPECT_EQ(count("cuModuleUnload"), 1u);
  EXPECT_EQ(count("cuStreamDestroy"), 1u);
}

TEST_F(CudaDeviceTest, ADeviceThatCannotLoadItsKernelsReleasesTheCard) {
  fake.fail("cuModuleLoadData", 209);
  EXPECT_THROW(open(), SimulationError);
  EXPECT_EQ(fake.leaks(), 0u);
  EXPECT_EQ(count("cuStreamDestroy"), 1u);
}

TEST_F(CudaDeviceTest, TooLittleMemoryNamesBothNumbers) {
  CudaDevice device = open();
  const Address part = device.allocate(400000);
  EXPECT_EQ(device.free_bytes(), 600000u);
  EXPECT_EQ(message_of<SimulationError>([&] { device.allocate(700000); }),
            "the memory of the Fake card does not suffice: 0.7 MB were asked for, 0.6 MB are free; "
            "give fewer particles or a larger dx");
  device.free(part);
  EXPECT_EQ(device.free_bytes(), 1000000u);
}

TEST_F(CudaDeviceTest, AKernelThatFailsIsReportedWhereTheProgramWaits) {
  CudaDevice device = open();
  const Address values = device.allocate(8);
  add_one(device, values, 2);
  fake.fail("cuStreamSynchronize", 719);
  int downloaded[2];
  EXPECT_EQ(
      message_of<SimulationError>([&] { device.download(downloaded, values, sizeof downloaded); }),
      "graphics card: a kernel or a copy failed: CUDA_ERROR_LAUNCH_FAILED (as the test "
      "wants)");
  device.free(values);
}

TEST_F(CudaDeviceTest, ALaunchThatFailsNamesTheKernel) {
  CudaDevice device = open();
  int count = 0;
  Address nothing = 0;
  void* arguments[] = {&nothing, &count};
  EXPECT_NE(message_of<SimulationError>([&] {
              device.launch("none", {1, 1}, arguments);
            }).find("looking up the kernel none failed"),
            std::string::npos);
  fake.fail("cuLaunchKernel", 1);
  EXPECT_NE(message_of<SimulationError>([&] {
              add_one(device, 0, 0);
            }).find("launching the kernel add_one failed"),
            std::string::npos);
}

TEST_F(CudaDeviceTest, AsksOnceForMoreSharedMemoryThanAllCardsGive) {
  CudaDevice device = open();
  add_one(device, 0, 0, 48 * 1024);
  EXPECT_EQ(count("cuFuncSetAttribute"), 0u);
  add_one(device, 0, 0, 100 * 1024);
  add_one(device, 0, 0, 90 * 1024);
  EXPECT_EQ(count("cuFuncSetAttribute"), 1u);
  EXPECT_EQ(count("cuModuleGetFunction"), 1u);  // the kernel is looked up once, too
}

TEST_F(CudaDeviceTest, NothingToDoIsNoCallOfTheDriver) {
  CudaDevice device = open();
  EXPECT_EQ(device.allocate(0), 0u);
  device.free(0);
  device.upload(0, nullptr, 0);
  device.clear(0, 0);
  device.launch("add_one", {0, 32}, nullptr);
  EXPECT_EQ(count("cuLaunchKernel") + count("cuMemAlloc") + count("cuMemFree") +
                count("cuMemcpyHtoDAsync") + count("cuMemsetD8Async"),
            0u);
}

TEST_F(CudaDeviceTest, AnyThreadMayCall) {
  CudaDevice device = open();
  Address values = 0;
  std::thread([&] { values = device.allocate(8); }).join();
  EXPECT_NE(values, 0u);
  device.free(values);
}

}  // namespace
}  // namespace snowshed::gpu
