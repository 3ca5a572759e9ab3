// Translates the core's errors into Python exceptions.
#include "snowshed/core/errors.hpp"

#include <cstring>
#include <filesystem>

#include "bindings.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

/// A text that may name files, whose names need not be UTF-8.
py::str text(const std::string& message) {
  PyObject* made =
      PyUnicode_DecodeUTF8(message.data(), py::ssize_t(message.size()), "surrogateescape");
  if (!made) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(made);
}

/// An OSError with its three parts.
void raise_os_error(const py::handle& type, int code, const std::string& what,
                    const std::string& file) {
  const py::tuple parts = py::make_tuple(code, text(what), text(file));
  PyErr_SetObject(type.ptr(), parts.ptr());
}

}  // namespace

void register_errors(py::module_& m) {
  // The exception types live as long as the interpreter.
  static py::handle input, simulation, file;
  input = py::exception<InputError>(m, "InputError", PyExc_ValueError).release();
  simulation = py::exception<SimulationError>(m, "SimulationError", PyExc_RuntimeError).release();
  file = py::exception<FileError>(m, "FileError", PyExc_OSError).release();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      PyErr_SetObject(input.ptr(), text(error.what()).ptr());
    } catch (const SimulationError& error) {
      PyErr_SetObject(simulation.ptr(), text(error.what()).ptr());
    } catch (const FileError& error) {
      const std::string what = std::string(error.what()).substr(error.file().size() + 2);
      raise_os_error(file, error.code(), what, error.file());
    } catch (const std::filesystem::filesystem_error& error) {
      raise_os_error(file, error.code().value(), error.code().message(), error.path1().string());
    }
  });
}

}  // namespace snowshed
