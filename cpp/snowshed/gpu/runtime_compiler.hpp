// NVIDIA's runtime compiler (NVRTC), versions 12 and 13. Its library is opened while the program
// runs. It needs no driver and no card.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "snowshed/gpu/kernel_program.hpp"

namespace snowshed::gpu {

class SharedLibrary;

class RuntimeCompiler {
 public:
  /// Opens the library of this name. Throws Unavailable.
  explicit RuntimeCompiler(const std::string& library);

  int major() const { return major_; }
  std::string version() const;  ///< such as "13.0"

  /// Returns the architecture of the code for a card of a compute capability (90 for 9.0): the
  /// newest of the same major version that the compiler knows and the card runs. Throws
  /// Unavailable if there is none.
  int architecture_for(int compute_capability) const;

  /// Returns the machine code for an architecture. Throws Unavailable with the compiler's log if
  /// the program does not compile.
  std::string compile(const KernelProgram&, int architecture) const;

 private:
  using Result = int;  // 0: success
  using Program = struct ProgramTag*;
  class Compilation;

  void find_functions(const SharedLibrary&);
  void check(Result, const char* action) const;

  Result (*Version)(int* major, int* minor);
  const char* (*GetErrorString)(Result);
  Result (*CreateProgram)(Program*, const char* source, const char* name, int header_count,
                          const char* const* headers, const char* const* header_names);
  Result (*DestroyProgram)(Program*);
  Result (*CompileProgram)(Program, int option_count, const char* const* options);
  Result (*GetProgramLogSize)(Program, std::size_t*);
  Result (*GetProgramLog)(Program, char*);
  Result (*GetCUBINSize)(Program, std::size_t*);
  Result (*GetCUBIN)(Program, char*);
  Result (*GetNumSupportedArchs)(int*);
  Result (*GetSupportedArchs)(int*);

  int major_ = 0, minor_ = 0;
};

using Folders = std::vector<std::filesystem::path>;

/// Sets the function that returns folders in which the compiler may lie, besides those of the
/// system. It is called when a compiler is needed, not before.
void set_compiler_folders(std::function<Folders()>);

/// Opens the compiler: the library that the environment variable SNOWSHED_NVRTC names; otherwise
/// the first one in the folders set above, or where the system's loader looks. A driver loads code
/// of compilers up to its own major version of CUDA only; newer ones are passed over. Throws
/// Unavailable.
RuntimeCompiler open_compiler(int max_major);

}  // namespace snowshed::gpu
