// Slides as simulations: checkpoints beside files that are not what they were.
#include <gtest/gtest.h>

#include "io/forged_archive.hpp"
#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

class SlideRun : public TemporaryFolder {
 protected:
  /// Saves half a metre of snow on an incline, of which no map is given, and returns the bytes.
  std::string checkpoint() const {
    std::string heights = "ncols 20\nnrows 15\nxllcenter 0\nyllcenter 0\ncellsize 2\n";
    for (int row = 0; row < 15; ++row) {
      for (int column = 0; column < 20; ++column) heights += std::to_string(100 - column) + " ";
      heights += "\n";
    }
    write_plainly(path("incline.asc"), heights);
    const Scene scene = parse_scene(R"({"snowshed": 2, "method": "slide", "dimension": 3,
      "terrain": {"file": "incline.asc",
        "release": [{"outline": [[8, 8], [20, 8], [20, 20]], "thickness": 0.5}]},
      "numerics": {"cell": 2, "threads": 1}})");
    Simulation sim(scene, path(""));
    sim.begin_event();
    sim.save(path("checkpoint"));
    return content(path("checkpoint"));
  }

  /// Loads a checkpoint of these bytes, and returns what it is refused with.
  InputError refusal_of(const std::string& bytes) const {
    write_plainly(path("forged"), bytes);
    try {
      Simulation::load(path("forged"));
    } catch (const InputError& error) {
      return error;
    }
    return {"", "nothing was refused"};
  }
};

TEST_F(SlideRun, ACheckpointWithTheMarkOfAnotherTerrainIsRefused) {
  const std::string bytes = checkpoint();
  const InputError error = refusal_of(forged(bytes, data_of(bytes, "ground"), std::int64_t(1)));
  EXPECT_EQ(error.where(), "incline.asc") << error.what();
}

TEST_F(SlideRun, ACheckpointWithTheMarkOfAFileThatItsSceneDoesNotNameIsRefused) {
  const std::string bytes = checkpoint();
  const InputError error = refusal_of(forged(bytes, data_of(bytes, "ground") + 8, std::int64_t(1)));
  EXPECT_EQ(error.where(), path("forged").string()) << error.what();
}

}  // namespace
}  // namespace snowshed
