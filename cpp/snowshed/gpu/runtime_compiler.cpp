#include "snowshed/gpu/runtime_compiler.hpp"

#include <algorithm>

#include "snowshed/gpu/embedded_sources.hpp"
#include "snowshed/gpu/shared_library.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

/// Pointers to texts, as C functions take them.
std::vector<const char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  return pointers;
}

}  // namespace

/// A compilation of one program, with the compiler's memory for it.
class RuntimeCompiler::Compilation {
 public:
  Compilation(const RuntimeCompiler& compiler, const KernelProgram& program) : compiler_(compiler) {
    std::vector<const char*> names, texts;
    for (const SourceText& source : embedded_sources()) {
      names.push_back(source.name);
      texts.push_back(source.text);
    }
    compiler.check(compiler.CreateProgram(&program_, program.source.c_str(), program.name.c_str(),
                                          int(names.size()), texts.data(), names.data()),
                   "creating a program");
  }
  Compilation(const Compilation&) = delete;
  Compilation& operator=(const Compilation&) = delete;
  ~Compilation() { compiler_.DestroyProgram(&program_); }

  bool run(const std::vector<std::string>& options) {
    const std::vector<const char*> texts = pointers_to(options);
    return compiler_.CompileProgram(program_, int(texts.size()), texts.data()) == 0;
  }
  std::string log() const {
    return contents(compiler_.GetProgramLogSize, compiler_.GetProgramLog).c_str();
  }
  std::string machine_code() const { return contents(compiler_.GetCUBINSize, compiler_.GetCUBIN); }

 private:
  std::string contents(Result (*size)(Program, std::size_t*), Result (*get)(Program, char*)) const {
    std::size_t bytes = 0;
    compiler_.check(size(program_, &bytes), "asking for a size");
    std::string buffer(bytes, '\0');
    compiler_.check(get(program_, buffer.data()), "reading a result");
    return buffer;
  }

  const RuntimeCompiler& compiler_;
  Program program_ = nullptr;
};

RuntimeCompiler::RuntimeCompiler(const std::string& library) {
  find_functions(SharedLibrary(library));
  check(Version(&major_, &minor_), "asking for its version");
}

void RuntimeCompiler::find_functions(const SharedLibrary& library) {
  library.find(Version, "nvrtcVersion");
  library.find(GetErrorString, "nvrtcGetErrorString");
  library.find(CreateProgram, "nvrtcCreateProgram");
  library.find(DestroyProgram, "nvrtcDestroyProgram");
  library.find(CompileProgram, "nvrtcCompileProgram");
  library.find(GetProgramLogSize, "nvrtcGetProgramLogSize");
  library.find(GetProgramLog, "nvrtcGetProgramLog");
  library.find(GetCUBINSize, "nvrtcGetCUBINSize");
  library.find(GetCUBIN, "nvrtcGetCUBIN");
  library.find(GetNumSupportedArchs, "nvrtcGetNumSupportedArchs");
  library.find(GetSupportedArchs, "nvrtcGetSupportedArchs");
}

void RuntimeCompiler::check(Result result, const char* action) const {
  if (result != 0)
    throw Unavailable("NVIDIA's runtime compiler: " + std::string(action) +
                      " failed: " + GetErrorString(result));
}

std::string RuntimeCompiler::version() const {
  return std::to_string(major_) + "." + std::to_string(minor_);
}

int RuntimeCompiler::architecture_for(int compute_capability) const {
  int count = 0;
  check(GetNumSupportedArchs(&count), "counting architectures");
  std::vector<int> known(std::size_t(count), 0);
  check(GetSupportedArchs(known.data()), "listing architectures");
  int best = 0;
  for (const int architecture : known)
    if (architecture <= compute_capability && architecture / 10 == compute_capability / 10)
      best = std::max(best, architecture);
  if (best) return best;
  const bool is_old = !known.empty() && compute_capability < known.front();
  throw Unavailable("NVIDIA's runtime compiler " + version() +
                    " does not know this card, of compute capability " +
                    std::to_string(compute_capability / 10) + "." +
                    std::to_string(compute_capability % 10) + "; " +
                    (is_old ? "version 12 knows older cards: pip install nvidia-cuda-nvrtc-cu12"
                            : "a newer version may: pip install --upgrade \"snowshed[gpu]\""));
}

std::string RuntimeCompiler::compile(const KernelProgram& program, int architecture) const {
  std::vector<std::string> options{"-std=c++17", "-default-device",
                                   "-arch=sm_" + std::to_string(architecture)};
  options.insert(options.end(), program.options.begin(), program.options.end());
  Compilation compilation(*this, program);
  if (!compilation.run(options))
    throw Unavailable("NVIDIA's runtime compiler " + version() + " cannot compile " + program.name +
                      ":\n" + compilation.log());
  return compilation.machine_code();
}

}  // namespace snowshed::gpu
