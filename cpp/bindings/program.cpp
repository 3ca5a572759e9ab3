// The program snowshed-run within the extension, so that a wheel holds the library once.
#include "snowshed/run/program.hpp"

#include <pybind11/stl.h>

#include "bindings.hpp"

namespace py = pybind11;

namespace snowshed {

void bind_program(py::module_& m) {
  m.def(
      "run_program",
      [](std::vector<std::string> arguments) {
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        return run::run_program(int(arguments.size()), argv.data());
      },
      py::arg("arguments"), py::call_guard<py::gil_scoped_release>(),
      "Run snowshed-run with these arguments, the first its name; returns its exit code.");
}

}  // namespace snowshed
