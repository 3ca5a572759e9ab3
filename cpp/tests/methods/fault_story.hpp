// Lack of memory in a method: every allocation of a story, told by two equal methods, fails once in
// one of them. Each failed call must leave it as the other is.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/allocation_fault.hpp"
#include "snowshed/io/binary_archive.hpp"

namespace snowshed {

/// Calls that are made of a method one after the other; those that read or write a checkpoint use
/// a file of their own.
template <class M>
class FaultStory {
 public:
  FaultStory(std::unique_ptr<M> made, std::filesystem::path file)
      : method(std::move(made)), file_(std::move(file)) {}

  void call(std::function<void(M&)> change) {
    calls.push_back([this, change = std::move(change)] { change(*method); });
  }
  void take_steps(int count) {
    for (int i = 0; i < count; ++i) call([](M& m) { m.step(); });
  }
  void save() {
    call([this](M&) { save_now(); });
  }
  void load() {
    call([this](M& m) { m.load(BinaryReader::load(file_)); });
  }

  void save_now() const {
    BinaryWriter out;
    method->save(out);
    out.save(file_);
  }

  std::unique_ptr<M> method;
  std::vector<std::function<void()>> calls;

 private:
  std::filesystem::path file_;
};

/// Tells both stories, lets every allocation of the second fail once, and returns how many there
/// were. `expect_same(now, wanted)` compares, `seen` is shown the first after each call.
template <class M, class ExpectSame, class Seen>
int fail_every_allocation(FaultStory<M>& whole, FaultStory<M>& faulty, ExpectSame expect_same,
                          Seen seen) {
  int faults = 0;
  for (std::size_t k = 0; k < whole.calls.size(); ++k) {
    for (std::int64_t n = 1;; ++n) {
      const FaultOutcome outcome = with_allocation_fault(n, faulty.calls[k]);
      if (outcome == FaultOutcome::no_fault) break;
      ++faults;
      SCOPED_TRACE("call " + std::to_string(k) + ", allocation " + std::to_string(n));
      // Streams do without some memory; what reads or writes a file may be done again.
      if (outcome == FaultOutcome::done_without) whole.calls[k]();
      expect_same(*faulty.method, *whole.method);
      if (testing::Test::HasFailure()) return faults;
    }
    whole.calls[k]();
    seen(*whole.method);
  }
  expect_same(*faulty.method, *whole.method);
  return faults;
}

}  // namespace snowshed
