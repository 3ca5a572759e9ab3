// A scene that Python passes to the core: parsed once, or as JSON text.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "snowshed/scene/scene_json.hpp"

namespace snowshed {

/// A complete scene and its JSON text.
struct ParsedScene {
  scene::Scene scene;
  std::string json;

  explicit ParsedScene(scene::Scene complete)
      : scene(std::move(complete)), json(snowshed::scene::write_scene(scene)) {}
};

/// The scene of an argument, which is a ParsedScene or JSON text; only text is parsed.
inline scene::Scene scene_of(const pybind11::object& argument) {
  if (pybind11::isinstance<ParsedScene>(argument)) return argument.cast<const ParsedScene&>().scene;
  if (pybind11::isinstance<pybind11::str>(argument))
    return scene::parse_scene(argument.cast<std::string>());
  throw pybind11::type_error("scene: a ParsedScene or JSON text is needed");
}

}  // namespace snowshed
