#include "bindings/use_guard.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace snowshed {
namespace {

using Access = Guarded<std::vector<int>>::Access;

/// ThreadSanitizer reports every change that another thread could see half done.
TEST(UseGuard, AdmitsOneThreadAtATime) {
  Guarded<std::vector<int>> guarded(std::vector<int>(100, 0));
  constexpr int threads = 3, calls = 2000;
  std::vector<int> done(threads, 0), refused(threads, 0);
  const auto use = [&](int thread) {
    for (int call = 0; call < calls; ++call) try {
        guarded.use("change", Access::change, [](std::vector<int>& values) {
          for (int& value : values) ++value;
        });
        ++done[std::size_t(thread)];
      } catch (const std::runtime_error&) {
        ++refused[std::size_t(thread)];
      }
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(use, thread);
  use(0);
  for (std::thread& other : others) other.join();
  int all = 0;
  for (int thread = 0; thread < threads; ++thread) {
    EXPECT_EQ(done[std::size_t(thread)] + refused[std::size_t(thread)], calls);
    all += done[std::size_t(thread)];
  }
  const auto values = guarded.use("read", Access::read, [](const auto& v) { return v; });
  EXPECT_EQ(values, std::vector<int>(100, all));
}

TEST(UseGuard, NestedCallsMayReadButNotChange) {
  Guarded<int> guarded(1);
  guarded.use("run", Guarded<int>::Access::change, [&](int&) {
    EXPECT_EQ(guarded.use("look", Guarded<int>::Access::read, [](int n) { return n; }), 1);
    EXPECT_THROW(guarded.use("step", Guarded<int>::Access::change, [](int&) {}),
                 std::runtime_error);
  });
  EXPECT_NO_THROW(guarded.use("step", Guarded<int>::Access::change, [](int&) {}));
}

}  // namespace
}  // namespace snowshed
