// Sequences of calls, to test lack of memory: two equal methods get the same calls, and every
// allocation of one of them fails once. After a failed call both must have the same state.
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

namespace snowshed::methods {

/// A method and the calls that it gets, in order. Calls that read or write a checkpoint use a file
/// of this sequence.
template <class M>
class CallSequence {
 public:
  CallSequence(std::unique_ptr<M> new_method, std::filesystem::path file)
      : method(std::move(new_method)), file_(std::move(file)) {}

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
    call([this](M& m) { m.load(io::BinaryReader::load(file_)); });
  }

  void save_now() const {
    io::BinaryWriter out;
    method->save(out);
    out.save(file_);
  }

  std::unique_ptr<M> method;
  std::vector<std::function<void()>> calls;

 private:
  std::filesystem::path file_;
};

/// Makes the calls of both sequences, lets every allocation of the second fail once, and returns
/// the number of failures. `expect_same(faulty, reference)` compares the methods after each
/// failure; `after_call(reference)` runs after each call of the reference.
template <class M, class ExpectSame, class AfterCall>
int fail_every_allocation(CallSequence<M>& reference, CallSequence<M>& faulty,
                          ExpectSame expect_same, AfterCall after_call) {
  int faults = 0;
  for (std::size_t k = 0; k < reference.calls.size(); ++k) {
    for (std::int64_t n = 1;; ++n) {
      const FaultOutcome outcome = with_allocation_fault(n, faulty.calls[k]);
      if (outcome == FaultOutcome::no_fault) break;
      ++faults;
      SCOPED_TRACE("call " + std::to_string(k) + ", allocation " + std::to_string(n));
      // Streams can recover from a lack of memory. The call has then succeeded, so the reference
      // makes it, too. Both repeat it later, which is harmless because such calls only read or
      // write files.
      if (outcome == FaultOutcome::recovered) reference.calls[k]();
      expect_same(*faulty.method, *reference.method);
      if (testing::Test::HasFailure()) return faults;
    }
    reference.calls[k]();
    after_call(*reference.method);
  }
  expect_same(*faulty.method, *reference.method);
  return faults;
}

}  // namespace snowshed::methods
