// Films of runs, frame by frame.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "array_copies.hpp"
#include "bindings.hpp"
#include "snowshed/io/checksum.hpp"
#include "snowshed/io/film_file.hpp"

namespace py = pybind11;

namespace snowshed {
namespace {

py::list quantity_list(const io::FilmHeader& header) {
  py::list list;
  for (const io::FilmQuantity& q : header.quantities)
    list.append(py::make_tuple(q.name, q.unit, q.meaning, q.step));
  return list;
}

/// Columns as an array (n, columns).
py::array_t<std::int32_t> table(const std::vector<std::vector<std::int32_t>>& columns,
                                std::size_t rows) {
  py::array_t<std::int32_t> a({py::ssize_t(rows), py::ssize_t(columns.size())});
  auto out = a.mutable_unchecked<2>();
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (std::size_t i = 0; i < rows; ++i) out(py::ssize_t(i), py::ssize_t(c)) = columns[c][i];
  return a;
}

py::dict next_frame(io::FilmReader& reader) {
  if (reader.position() == reader.frames().size())
    throw py::stop_iteration("the film has no more frames");
  const io::FilmFrame frame = reader.next();
  py::dict d;
  d["time"] = frame.time;
  d["event"] = frame.event;
  d["ids"] = column<std::int64_t>(frame.ids);
  d["events"] = column<std::int64_t>(frame.events);
  d["materials"] = column<std::int64_t>(frame.materials);
  d["radii"] = column<std::int32_t>(frame.radii);
  d["positions"] = table(frame.positions, frame.ids.size());
  d["codes"] = table(frame.values, frame.ids.size());
  return d;
}

/// Checksum of a film up to the end of its first `frames` frames.
std::string film_checksum(const io::FilmReader& reader, std::size_t frames) {
  if (frames > reader.frames().size()) throw py::index_error("the film has fewer frames");
  return io::hexadecimal(reader.checksum(frames));
}

}  // namespace

void bind_film(py::module_& m) {
  using namespace py::literals;
  py::class_<io::FilmReader>(m, "FilmReader")
      .def(py::init<std::filesystem::path>(), "path"_a)
      .def("next", &next_frame)
      .def("checksum", &film_checksum, "frames"_a)
      .def_property_readonly("version", &io::FilmReader::version)
      .def_property_readonly("whole", &io::FilmReader::is_complete)
      .def_property_readonly("closed", &io::FilmReader::closed)
      .def_property_readonly("axes", [](const io::FilmReader& r) { return r.header().axes; })
      .def_property_readonly("quantum_m",
                             [](const io::FilmReader& r) { return r.header().quantum; })
      .def_property_readonly("interval_s",
                             [](const io::FilmReader& r) { return r.header().interval; })
      .def_property_readonly("share", [](const io::FilmReader& r) { return r.header().share; })
      .def_property_readonly("quantities",
                             [](const io::FilmReader& r) { return quantity_list(r.header()); })
      .def_property_readonly("frames", [](const io::FilmReader& r) {
        py::list list;
        for (const io::FilmFrameInfo& f : r.frames())
          list.append(py::make_tuple(f.time, f.event, f.particles));
        return list;
      });
}

}  // namespace snowshed
