// Fuzz target of films. A file must be refused, or yield frames with lists of equal length, and a
// run must be able to append to it.
#include "fuzzing.hpp"
#include "snowshed/io/film_file.hpp"

namespace snowshed {
namespace {

void check_frame(const io::FilmFrame& frame, const io::FilmHeader& header, std::size_t particles) {
  const auto has_all = [particles](const auto& values) { return values.size() == particles; };
  require(has_all(frame.ids) && has_all(frame.events) && has_all(frame.materials), "lists");
  require(!header.has_radius || has_all(frame.radii), "radii");
  require(frame.positions.size() == std::size_t(header.axes), "axes");
  require(frame.values.size() == header.quantities.size(), "quantities");
  for (const auto& axis : frame.positions) require(has_all(axis), "positions");
  for (const auto& quantity : frame.values) require(has_all(quantity), "values");
  for (std::size_t i = 1; i < particles; ++i)
    require(frame.ids[i - 1] < frame.ids[i], "ids do not rise");
}

void extend_film(const std::filesystem::path& path) {
  io::FilmWriter writer =
      io::FilmWriter::reopen(path, [](const io::FilmFrameInfo&) { return true; });
  io::FilmFrame empty;
  empty.positions.resize(std::size_t(writer.header().axes));
  empty.values.resize(writer.header().quantities.size());
  writer.append(empty);
  writer.close();
  const io::FilmReader reader(path);
  require(reader.is_complete() && reader.closed(), "the film does not end");
  require(reader.frames().size() == writer.frames().size(), "frames are lost");
}

}  // namespace
}  // namespace snowshed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, ".bin");
  allow_refusal([&] {
    io::FilmReader reader(file.path());
    for (const io::FilmFrameInfo& info : reader.frames())
      check_frame(reader.next(), reader.header(), info.particles);
    extend_film(file.path());
  });
  return 0;
}
