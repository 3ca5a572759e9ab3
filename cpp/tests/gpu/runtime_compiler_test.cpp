#include "snowshed/gpu/runtime_compiler.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "gpu/cuda_testing.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/gpu/embedded_sources.hpp"
#include "snowshed/gpu/machine_code.hpp"
#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

using io::message_of;

/// All laws, in both precisions, as kernels use them.
const KernelProgram laws{"laws.cu", R"(
#include "snowshed/material/cam_clay.hpp"
#include "snowshed/material/elastic.hpp"
#include "snowshed/material/sym_tensor.hpp"
using namespace snowshed::material;

template <class T, bool regularised>
void return_stress(const CamClayLaw<T, regularised>& law, T* values) {
  T* own = values + 8 * (blockIdx.x * blockDim.x + threadIdx.x);
  PQ<T> s{own[0], own[1]};
  law.return_map(s, own[2], T(0.1));
  Sym<T, 3> strain{{s.p, s.q, own[3], own[4], own[5], own[6]}};
  own[7] = trace(cauchy_green_minus_identity(hencky_strain(strain)));
}

extern "C" __global__ void law_float(CamClayLaw<float, false> law, float* values) {
  return_stress(law, values);
}
extern "C" __global__ void law_float_regularised(CamClayLaw<float, true> law, float* values) {
  return_stress(law, values);
}
extern "C" __global__ void law_double(CamClayLaw<double, true> law, double* values) {
  return_stress(law, values);
}
extern "C" __global__ void elastic(Elastic<float> law, float* values) {
  values[threadIdx.x] *= law.elastic.mu;
}
)"};

std::string read(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(EmbeddedSources, AreTheHeadersOfTheCoreUnchanged) {
  int of_the_core = 0;
  for (const SourceText& source : embedded_sources()) {
    const std::string file = std::string(SNOWSHED_SOURCE_DIR "/cpp/") + source.name;
    if (std::string(source.name).find("/material/") == std::string::npos) continue;
    EXPECT_EQ(source.text, read(file)) << source.name;
    ++of_the_core;
  }
  EXPECT_EQ(of_the_core, 4);
}

TEST(RuntimeCompiler, CompilesTheLawsOfTheCoreUnchanged) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  for (const int architecture : {compiler->architecture_for(80), compiler->architecture_for(90)}) {
    const std::string code = compiler->compile(laws, architecture);
    EXPECT_EQ(code.substr(1, 3), "ELF");
    EXPECT_NE(code.find("law_float_regularised"), std::string::npos);
  }
}

TEST(RuntimeCompiler, CompilesTheKernelsOfEveryMethod) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  int methods = 0;
  for (const SourceText& source : embedded_sources()) {
    const std::string name = source.name, last = "/gpu/kernels.cuh";
    if (name.size() < last.size() || name.substr(name.size() - last.size()) != last) continue;
    EXPECT_FALSE(
        compiler->compile({"kernels of " + name, "#include \"" + name + "\"\n"}, 90).empty());
    ++methods;
  }
  EXPECT_EQ(methods, 1);
}

TEST(RuntimeCompiler, TheErrorHasTheLogWithFileAndLine) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const std::string message = message_of<Unavailable>(
      [&] { compiler->compile({"wrong.cu", "\nextern \"C\" __global__ void k() { snow; }"}, 90); });
  EXPECT_NE(message.find("cannot compile wrong.cu:\nwrong.cu(2): error"), std::string::npos)
      << message;
  EXPECT_NE(message.find("snow"), std::string::npos);
}

TEST(RuntimeCompiler, OptionsReachTheCompiler) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const KernelProgram program{"option.cu", "static_assert(DEPTH == 3);", {"-DDEPTH=3"}};
  EXPECT_NO_THROW(compiler->compile(program, 90));
}

TEST(RuntimeCompiler, CodeForAnOlderCardOfTheSameFamilyServesANewerOne) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  EXPECT_EQ(compiler->architecture_for(90), 90);
  EXPECT_EQ(compiler->architecture_for(99), 90);
  EXPECT_NE(message_of<Unavailable>([&] { compiler->architecture_for(990); }).find("99.0"),
            std::string::npos);
  EXPECT_NE(message_of<Unavailable>([&] {
              compiler->architecture_for(35);
            }).find("does not know this card, of compute capability 3.5"),
            std::string::npos);
}

class MachineCode : public io::TemporaryFolder {
 protected:
  std::filesystem::path file() const {
    return std::filesystem::directory_iterator(machine_code_folder())->path();
  }

  Variable cache{"XDG_CACHE_HOME", path("cache").c_str()};
  KernelProgram program{"one.cu", "extern \"C\" __global__ void one() {}"};
};

TEST_F(MachineCode, IsReadFromTheFileThatTheFirstCompilationWrote) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const std::string code = machine_code(*compiler, program, 90);
  const auto written = std::filesystem::last_write_time(file());
  EXPECT_EQ(machine_code(*compiler, program, 90), code);
  EXPECT_EQ(std::filesystem::last_write_time(file()), written);
}

TEST_F(MachineCode, OtherOptionsHaveTheirOwnCode) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  program.source = "extern \"C\" __global__ void NAME() {}";
  program.options = {"-DNAME=first"};
  machine_code(*compiler, program, 90);
  program.options = {"-DNAME=second"};
  EXPECT_NE(machine_code(*compiler, program, 90).find("second"), std::string::npos);
}

TEST_F(MachineCode, ADamagedFileIsCompiledAgain) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const std::string code = machine_code(*compiler, program, 90);
  std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(200);
  stream.put('!');
  stream.close();
  EXPECT_EQ(machine_code(*compiler, program, 90), code);
}

TEST_F(MachineCode, AFolderThatCannotBeWrittenIsNoError) {
  SNOWSHED_REQUIRE_COMPILER(compiler);
  const Variable file_in_place("XDG_CACHE_HOME", "/dev/null");
  EXPECT_FALSE(machine_code(*compiler, program, 90).empty());
}

}  // namespace
}  // namespace snowshed::gpu
