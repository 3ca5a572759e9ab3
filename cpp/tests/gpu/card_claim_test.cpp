#include "snowshed/gpu/card_claim.hpp"

#include <gtest/gtest.h>

#include "gpu/cuda_testing.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/gpu/card.hpp"

namespace snowshed::gpu {
namespace {

/// A user's cache that nothing else uses.
struct CardClaims : io::TemporaryFolder {
  const Variable cache{"XDG_CACHE_HOME", path("").c_str()};
};

TEST_F(CardClaims, RunsTakeTheCardOnWhichTheFewestOthersCompute) {
  const auto first = claim_card({"a", "b"});
  auto second = claim_card({"a", "b"});
  const auto third = claim_card({"a", "b"});
  EXPECT_EQ(first.number, 0);
  EXPECT_EQ(second.number, 1);
  EXPECT_EQ(third.number, 0);
  second.claim.reset();
  EXPECT_EQ(claim_card({"a", "b"}).number, 1);
}

TEST_F(CardClaims, ACardIsTheSameWhateverTheListOfAProcess) {
  const auto other = claim_card({"b", "c"});
  EXPECT_EQ(claim_card({"a", "b"}).number, 0);
  EXPECT_EQ(claim_card({"b", "a"}).number, 1);
}

TEST_F(CardClaims, ASingleCardNeedsNoClaim) {
  EXPECT_EQ(claim_card({"a"}).claim, nullptr);
  EXPECT_EQ(number_of_files(), 0u);
}

TEST_F(CardClaims, WithoutAFolderForClaimsRunsShareTheFirstCard) {
  const Variable none("XDG_CACHE_HOME", "/dev/null");
  const auto claimed = claim_card({"a", "b"});
  EXPECT_EQ(claimed.number, 0);
  EXPECT_EQ(claimed.claim, nullptr);
}

TEST_F(CardClaims, AnOpenDeviceHoldsItsCardAndAClosedOneReleasesIt) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const FakeCuda fake;
  fake.set_cards(2);
  const KernelProgram program{"one.cu", "extern \"C\" __global__ void add_one() {}"};
  const auto device = open_device(find_card(fake.driver()), program);
  EXPECT_EQ(find_card(fake.driver()).number, 1);
  {
    const auto other = open_device(find_card(fake.driver()), program);
    EXPECT_EQ(find_card(fake.driver()).number, 0);
  }
  EXPECT_EQ(find_card(fake.driver()).number, 1);
}

TEST(Cards, AreCountedByTheDriver) {
  const FakeCuda fake;
  const Variable driver("SNOWSHED_CUDA", SNOWSHED_FAKE_CUDA);
  fake.set_cards(3);
  EXPECT_EQ(count_cards(), 3);
  fake.set_cards(0);
  EXPECT_EQ(count_cards(), 0);
}

TEST(Cards, AreNoneWithoutADriver) {
  const Variable driver("SNOWSHED_CUDA", "/nonexistent/libcuda.so.1");
  EXPECT_EQ(count_cards(), 0);
}

}  // namespace
}  // namespace snowshed::gpu
