// Fuzz target of scenes. A text must be refused, or give a scene that stays the same when it is
// written and read again.
#include "fuzzing.hpp"
#include "snowshed/run/cost_estimate.hpp"
#include "snowshed/scene/scene_json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snowshed;
  allow_refusal([&] {
    const scene::Scene scene = scene::parse_scene({reinterpret_cast<const char*>(data), size});
    const std::string written = scene::write_scene(scene);
    try {
      require(write_scene(scene::parse_scene(written)) == written,
              "a scene changes when it is written");
    } catch (const InputError& error) {
      throw std::logic_error(std::string("a scene is refused once it is written: ") + error.what());
    }
    if (scene.numerics.takes(methods::Part::bodies)) {
      run::estimate_cost(scene);
      run::estimate_cost(scene, {100});
    }
  });
  return 0;
}
