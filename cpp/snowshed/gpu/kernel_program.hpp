// A program of kernels before its compilation for a card.
#pragma once

#include <string>
#include <vector>

namespace snowshed::gpu {

/// A program of kernels, whose functions are `extern "C"` so that they keep their names. It may
/// include the embedded sources.
struct KernelProgram {
  std::string name;                    // in messages of the compiler
  std::string source;                  // CUDA C++17
  std::vector<std::string> options{};  // for the compiler, such as "-DNAME=VALUE"
};

}  // namespace snowshed::gpu
