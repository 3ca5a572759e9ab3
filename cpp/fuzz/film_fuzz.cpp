// Fuzz target of films. A file must be refused, or give frames whose lists belong together; and a
// run must be able to go on with it.
#include "fuzzing.hpp"
#include "snowshed/io/film_file.hpp"

namespace snowshed {
namespace {

void check_frame(const FilmFrame& frame, const FilmHeader& header, std::size_t particles) {
  const auto of_all = [particles](const auto& values) { return values.size() == particles; };
  require(of_all(frame.ids) && of_all(frame.events) && of_all(frame.materials), "lists");
  require(!header.has_radius || of_all(frame.radii), "radii");
  require(frame.positions.size() == std::size_t(header.axes), "axes");
  require(frame.values.size() == header.quantities.size(), "quantities");
  for (const auto& axis : frame.positions) require(of_all(axis), "positions");
  for (const auto& quantity : frame.values) require(of_all(quantity), "values");
  for (std::size_t i = 1; i < particles; ++i)
    require(frame.ids[i - 1] < frame.ids[i], "ids do not rise");
}

void go_on(const std::filesystem::path& path) {
  FilmWriter writer = FilmWriter::reopen(path, [](const FilmFrameInfo&) { return true; });
  FilmFrame empty;
  empty.positions.resize(std::size_t(writer.header().axes));
  empty.values.resize(writer.header().quantities.size());
  writer.append(empty);
  writer.close();
  const FilmReader reader(path);
  require(reader.is_complete() && reader.closed(), "the film does not end");
  require(reader.frames().size() == writer.frames().size(), "frames are lost");
}

}  // namespace
}  // namespace snowshed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  const InputFile file(data, size, ".bin");
  allow_refusal([&] {
    FilmReader reader(file.path());
    for (const FilmFrameInfo& info : reader.frames())
      check_frame(reader.next(), reader.header(), info.particles);
    go_on(file.path());
  });
  return 0;
}
