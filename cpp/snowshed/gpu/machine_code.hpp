// Machine code of kernels, compiled once.
#pragma once

#include <filesystem>
#include <string>

#include "snowshed/gpu/kernel_program.hpp"
#include "snowshed/gpu/runtime_compiler.hpp"

namespace snowshed::gpu {

/// Returns the machine code of a program for an architecture. It is compiled by the first process
/// that asks for it, which takes some seconds, and kept in `machine_code_folder`, if that can be
/// written. Changed sources, options and compilers have code of their own. Throws as
/// RuntimeCompiler::compile.
std::string machine_code(const RuntimeCompiler&, const KernelProgram&, int architecture);

/// The folder for machine code: snowshed/kernels in $XDG_CACHE_HOME, or in ~/.cache. Empty if there
/// is no home.
std::filesystem::path machine_code_folder();

}  // namespace snowshed::gpu
