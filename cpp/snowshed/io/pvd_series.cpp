#include "snowshed/io/pvd_series.hpp"

#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "snowshed/core/errors.hpp"
#include "snowshed/io/atomic_file.hpp"
#include "snowshed/io/checksum.hpp"
#include "snowshed/io/file_bytes.hpp"
#include "snowshed/io/xml_text.hpp"

namespace snowshed::io {
namespace {

// A host program may have set a locale with decimal commas; files always have decimal points.

std::optional<double> to_number(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value;
  stream >> value;
  if (!stream || !stream.eof() || !std::isfinite(value)) return {};
  return value;
}

/// Returns the shortest text that reads back as the same number, so that times can be compared
/// exactly.
std::string to_text(double value) {
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(digits);
    stream << value;
    text = stream.str();
    if (to_number(text) == value) break;
  }
  return text;
}

std::optional<std::string> attribute(std::string_view element, const std::string& name) {
  const std::string opening = " " + name + "=\"";
  const std::size_t start = element.find(opening);
  if (start == std::string_view::npos) return {};
  const std::string_view value = element.substr(start + opening.size());
  const std::size_t end = value.find('"');
  if (end == std::string_view::npos) return {};
  return xml_unescape(value.substr(0, end));
}

/// Returns the entry in a line of the file, if it has one.
std::optional<PvdSeries::Entry> parse_line(const std::string& line, const std::string& where) {
  if (line.find("<DataSet ") == std::string::npos) return {};
  const auto time = attribute(line, "timestep");
  const auto file = attribute(line, "file");
  const auto seconds = time ? to_number(*time) : std::nullopt;
  if (!seconds || !file || line.find("/>") == std::string::npos)
    throw InputError(where, "a DataSet needs a finite timestep and a file");
  return PvdSeries::Entry{*seconds, *file};
}

const std::string comment_begins = "<!-- checksum ";

/// The comment that follows a text and contains its checksum.
std::string comment_of(const std::string& text) {
  Crc32 sum;
  sum.update(text.data(), text.size());
  return comment_begins + hexadecimal(sum.value()) + " -->\n";
}

}  // namespace

PvdSeries PvdSeries::reopen(std::filesystem::path path, double before) {
  PvdSeries series(std::move(path));
  if (!std::filesystem::exists(series.path_)) return series;
  const std::string text = read_bytes(series.path_);
  const std::size_t seal = text.find(comment_begins);
  if (seal != std::string::npos && text.substr(seal) != comment_of(text.substr(0, seal)))
    throw InputError(series.path_.string(), "damaged: its checksum is not that of its content");
  std::istringstream lines(text);
  bool closed = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = series.path_.string() + ":" + std::to_string(++number);
    const auto entry = parse_line(line, where);
    if (entry && entry->time < before) series.entries_.push_back(*entry);
    closed = closed || line.find("</VTKFile>") != std::string::npos;
  }
  if (!closed) throw InputError(series.path_.string(), "not a complete .pvd file: no </VTKFile>");
  return series;
}

void PvdSeries::append(double time, const std::string& file) {
  if (!std::isfinite(time) || (!entries_.empty() && time < entries_.back().time))
    throw std::invalid_argument("snapshot at " + to_text(time) + " s in " + path_.string() +
                                ": times must be finite and not decrease");
  entries_.push_back({time, file});
  save();
}

void PvdSeries::save() const {
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const Entry& entry : entries_)
    xml += "    <DataSet timestep=\"" + to_text(entry.time) + "\" part=\"0\" file=\"" +
           xml_escape(entry.file) + "\"/>\n";
  xml += "  </Collection>\n</VTKFile>\n";
  write_atomic(path_, xml + comment_of(xml));
}

}  // namespace snowshed::io
