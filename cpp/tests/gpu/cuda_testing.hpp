// A driver without a card, and NVIDIA's real compiler where it is installed.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "snowshed/gpu/cuda_driver.hpp"
#include "snowshed/gpu/runtime_compiler.hpp"
#include "snowshed/gpu/shared_library.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {

/// The fake driver, with all that was recorded before forgotten.
struct FakeCuda {
  FakeCuda() {
    library.find(fail, "fake_cuda_fail");
    library.find(reset, "fake_cuda_reset");
    library.find(calls, "fake_cuda_calls");
    library.find(set_cards, "fake_cuda_set_cards");
    library.find(leaks, "fake_cuda_leaks");
    reset();
  }
  std::shared_ptr<const CudaDriver> driver() const {
    return std::make_shared<const CudaDriver>(SNOWSHED_FAKE_CUDA);
  }

  SharedLibrary library{SNOWSHED_FAKE_CUDA};
  void (*fail)(const char* function, int result);
  void (*reset)();
  const char* (*calls)();
  void (*set_cards)(int cards);
  std::size_t (*leaks)();
};

/// Sets a variable of the environment while it exists; null: removes it.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value)
      ::setenv(name_, value, 1);
    else
      ::unsetenv(name_);
  }

  const char* name_;
  std::optional<std::string> before_;
};

/// The folders of NVIDIA's packages in the project's own environment.
inline Folders package_folders() {
  Folders folders;
  std::error_code error;
  const std::filesystem::path environment(SNOWSHED_SOURCE_DIR "/.venv/lib");
  for (const auto& python : std::filesystem::directory_iterator(environment, error))
    for (const char* package : {"nvidia/cu13/lib", "nvidia/cuda_nvrtc/lib"})
      folders.push_back(python.path() / "site-packages" / package);
  return folders;
}

/// The compiler; none if it is not installed.
inline std::optional<RuntimeCompiler> installed_compiler() try {
  set_compiler_folders(&package_folders);
  return open_compiler(13);
} catch (const Unavailable&) {
  return std::nullopt;
}

#define SNOWSHED_REQUIRE_COMPILER(compiler)                                  \
  const auto compiler = ::snowshed::gpu::installed_compiler();               \
  if (!compiler)                                                             \
  GTEST_SKIP() << "NVIDIA's runtime compiler is not installed: pip install " \
                  "nvidia-cuda-nvrtc, or name its library by SNOWSHED_NVRTC"

}  // namespace snowshed::gpu
