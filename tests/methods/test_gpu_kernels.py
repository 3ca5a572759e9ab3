"""The kernels compile for graphics cards, where NVIDIA's runtime compiler is installed."""

import ctypes
import importlib.util
import re
from pathlib import Path

import pytest

CPP = Path(__file__).parents[2] / "cpp"
STAND_INS = CPP / "snowshed" / "gpu" / "stand_ins"
#: Headers and the files that stand in for them, as the build embeds them.
EMBEDDED = (CPP.parent / "cmake" / "EmbeddedSources.cmake").read_text(encoding="utf-8")
STANDS_IN_FOR = {file: name for name, file in re.findall(r"^  (\S+)=(\w+\.cuh)", EMBEDDED, re.M)}


def runtime_compiler():
    """Return the library of the runtime compiler; skip the test if its wheel is not installed."""
    package = importlib.util.find_spec("nvidia")
    folders = package.submodule_search_locations if package else []
    libraries = [p for folder in folders for p in Path(folder).rglob("libnvrtc.so.*")]
    if not libraries:
        pytest.skip("the kernels are not compiled: the wheel nvidia-cuda-nvrtc is not installed")
    return ctypes.CDLL(str(libraries[0]))


def texts(values):
    """Return an array of C strings."""
    return (ctypes.c_char_p * len(values))(*values)


def compile_kernels(compiler, source, architecture):
    """Return the compiler's result and its log."""
    names = [name.encode() for name in STANDS_IN_FOR.values()]
    headers = [(STAND_INS / name).read_bytes() for name in STANDS_IN_FOR]
    program = ctypes.c_void_p()
    created = compiler.nvrtcCreateProgram(
        ctypes.byref(program), source, b"kernels.cu", len(names), texts(headers), texts(names)
    )
    assert created == 0
    options = [f"-I{CPP}", "-std=c++17", f"-arch={architecture}", "-default-device"]
    options = [option.encode() for option in options]
    result = compiler.nvrtcCompileProgram(program, len(options), texts(options))
    size = ctypes.c_size_t()
    compiler.nvrtcGetProgramLogSize(program, ctypes.byref(size))
    log = ctypes.create_string_buffer(size.value)
    compiler.nvrtcGetProgramLog(program, log)
    compiler.nvrtcDestroyProgram(ctypes.byref(program))
    return result, log.value.decode()


@pytest.mark.parametrize("architecture", ["sm_80", "sm_90"])
def test_all_kernels_compile_without_a_warning(architecture):
    source = (CPP / "snowshed/methods/mpm/gpu/energy_kernels.cuh").read_bytes()
    result, log = compile_kernels(runtime_compiler(), source, architecture)
    assert result == 0, log
    assert "warning" not in log


def test_a_fault_in_a_kernel_is_found():
    source = b'#include "snowshed/methods/mpm/gpu/views.hpp"\nint broken() { return missing; }\n'
    result, log = compile_kernels(runtime_compiler(), source, "sm_90")
    assert result != 0
    assert "missing" in log
