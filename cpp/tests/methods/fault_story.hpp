// Tests of lack of memory: two equal methods get the same calls, and every allocation fails once in
// one of them. After a failed call both methods must have the same state.
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

/// A method and the calls that it gets, in order. Calls that read or write a checkpoint use the
/// story's own file.
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

/// Makes the calls of both stories, lets every allocation of the second fail once, and returns the
/// number of failures. `expect_same(faulty, whole)` compares the methods, and `seen(whole)` is
/// called after each call of the first story.
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
      // Streams can do without some memory. The call has then succeeded, and is made again; this
      // changes nothing, because such calls read or write files.
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
