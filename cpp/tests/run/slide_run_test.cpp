// Slides as simulations: checkpoints whose files have changed.
#include <gtest/gtest.h>

#include "io/forged_archive.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed::methods::slide {
namespace {

class SlideRun : public io::TemporaryFolder {
 protected:
  /// Saves half a metre of snow on an incline, without a map of thickness, and returns the bytes.
  std::string checkpoint() const {
    std::string heights = "ncols 20\nnrows 15\nxllcenter 0\nyllcenter 0\ncellsize 2\n";
    for (int row = 0; row < 15; ++row) {
      for (int column = 0; column < 20; ++column) heights += std::to_string(100 - column) + " ";
      heights += "\n";
    }
    write_plainly(path("incline.asc"), heights);
    const scene::Scene scene =
        scene::parse_scene(R"({"snowshed": 2, "method": "slide", "dimension": 3,
      "terrain": {"file": "incline.asc",
        "release": [{"outline": [[8, 8], [20, 8], [20, 20]], "thickness": 0.5}]},
      "numerics": {"cell": 2, "threads": 1}})");
    run::Simulation sim(scene, path(""));
    sim.begin_event();
    sim.save(path("checkpoint"));
    return content(path("checkpoint"));
  }

  /// Returns the message with which a checkpoint is refused after the mark of a file was changed.
  /// File 0 is the terrain, file 1 the map of thickness.
  std::string refusal_with_mark_of(int file) const {
    const std::string bytes = checkpoint();
    const std::size_t mark = io::data_of(bytes, "ground") + 8 * std::size_t(file);
    write_plainly(path("forged"), io::forged(bytes, mark, std::int64_t(1)));
    return io::message_of<InputError>([&] { run::Simulation::load(path("forged")); });
  }
};

TEST_F(SlideRun, ACheckpointOfAnotherTerrainIsRefused) {
  EXPECT_EQ(refusal_with_mark_of(0), "incline.asc: has changed since the checkpoint " +
                                         path("forged").string() +
                                         " was made; restore the file, or start a new run");
}

TEST_F(SlideRun, AMarkOfAFileOutsideTheSceneIsRefused) {
  EXPECT_EQ(refusal_with_mark_of(1),
            path("forged").string() + ": holds the mark of a file that its scene does not name");
}

}  // namespace
}  // namespace snowshed::methods::slide
