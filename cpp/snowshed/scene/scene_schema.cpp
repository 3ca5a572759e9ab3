#include "snowshed/scene/json_text.hpp"
#include "snowshed/scene/scene_json.hpp"
#include "snowshed/scene/schema_writer.hpp"

namespace snowshed::scene {

std::string scene_schema() {
  nlohmann::ordered_json definitions = nlohmann::ordered_json::object();
  const auto scene = SchemaWriter::write<Scene>(definitions);
  nlohmann::ordered_json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"$id", "urn:snowshed:scene:" + std::to_string(scene_version)},
      {"title", "snowshed scene"},
      {"description",
       "Description of a simulation. SI units, angles in degrees. Vectors are [x, y, z] in 3D and "
       "[x, z] in 2D; x points down the slide direction, z up."},
  };
  schema.update(scene);
  schema["$defs"] = definitions;
  return indented_text(schema);
}

}  // namespace snowshed::scene
