// Writes the seed inputs of fuzzing:  fuzz_seeds FOLDER
// For each target, FOLDER gets a folder of small valid inputs and a dictionary of words.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "snowshed/io/film_file.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/run/simulation.hpp"
#include "snowshed/scene/presets.hpp"
#include "snowshed/scene/scene_json.hpp"

namespace snowshed {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

template <class Number>
std::string raw(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// A scene with every feature. Y(y) is the y component of a vector, which 2D scenes lack.
const char* const rich_scene = R"({"snowshed": 2, "dimension": %D, "title": "seed",
  "snow": {"model": "elastic", "density": 250, "cohesion": 0.1},
  "panel": {"height": 0.5, "length": 1, "width": 1, "tilt": 45, "condition": "separate"},
  "slab": {"layers": [{"thickness": 0.06, "snow": {"model": "cam_clay", "density": 100}},
                      {"thickness": 0.02, "event": 2}]}, "ground": {"tilt": 10, "friction": 0.5},
  "domain": {"min": [-9, Y(-9) -9], "max": [9, Y(9) 9]},
  "obstacles": [
    {"name": "fence", "condition": "sticky", "shape": {"type": "union", "shapes": [
      {"type": "box", "center": [1.3, Y(0) -0.1], "size": [0.04, Y(1) 0.3]},
      {"type": "capsule", "from": [1.3, Y(0) 0.05], "to": [1.2, Y(0) 0.15], "radius": 0.03},
      {"type": "cylinder", "from": [2, Y(0) 0.05], "to": [1.2, Y(1) 0.15], "radius": 0.03},
      {"type": "plate", "center": [2, Y(0) 1], "normal": [1, Y(0) 1], "length": 1, "width": 1,
       "thickness": 0.1},
      {"type": "plane", "center": [1, Y(0) 0], "normal": [0.1, Y(0) 1]}]},
     "motion": {"velocity": [1, Y(0) 0], "pivot": [1, Y(0) 0], "start": 0.1, "end": 0.5}},
    {"shape": {"type": "difference", "shapes": [
      {"type": "mesh", "file": "a.stl", "scale": 0.001},
      {"type": "grid", "file": "b.npy", "origin": [0, Y(0) 0], "spacing": 0.1},
      {"type": "transform", "angle": 30, "translate": [1, Y(0) 0],
       "shapes": [{"type": "sphere", "center": [0, Y(0) 0], "radius": 0.2}]}]}}],
  "bodies": [{"shape": {"type": "sphere", "center": [0.9, Y(0) 0.3], "radius": 0.08},
              "velocity": [0, Y(0) -1], "event": 2, "snow": {"density": 150}}],
  "seeding": {"particles_per_voxel": 6, "pattern": "jittered", "seed": 7, "allow_sparse": true},
  "numerics": {"dx": 0.02, "precision": "double", "transfer": "apic", "basis": "cubic",
               "courant_factor": 0.5, "strain_limit": 0.1, "threads": 1},
  "events": {"count": 2, "between": "reseed", "max_time": 3, "rest_speed": 0.02, "rest_time": 0.1},
  "output": {"snapshot_interval": 0.1, "energy": true, "checkpoint_interval": 60}})";

/// A slide on terrain, with every feature of the method.
const char* const slide_scene = R"({"snowshed": 2, "method": "slide", "dimension": 3,
  "terrain": {"file": "dem.asc", "crs": "EPSG:31287", "thickness_file": "depth.asc",
    "release": [{"name": "slab", "outline": [[10, 10], [30, 10], [30, 30]], "thickness": 0.5,
                 "holes": [{"outline": [[20, 12], [24, 12], [24, 15]]}]}],
    "entrainment": [{"outline": [[40, 10], [60, 10], [60, 30]], "thickness": 0.2}],
    "resistance": [{"outline": [[50, 10], [60, 10], [60, 30]]}]},
  "numerics": {"cell": 2, "time_step": 0.01, "friction_law": "coulomb", "bonds": true},
  "events": {"max_time": 10}})";

/// A sample that is loaded, with every feature of the method "grains".
const char* const grains_scene = R"({"snowshed": 2, "method": "grains", "dimension": 3,
  "sample": {"file": "labels.npy", "voxel_size": 5e-5},
  "loading": [{"kind": "compress", "speed": 0.02, "strain": 0.1, "stress": 1e4},
              {"kind": "unload", "stress": 10}, {"kind": "hold"}, {"kind": "penetrate"}],
  "cone": {"radius": 0.002, "half_angle": 30},
  "numerics": {"elastic_modulus": 1e8, "sides": "periodic", "bonded_plates": true}})";

/// A column that slumps onto snow that erodes.
const char* const mps_scene = R"({"snowshed": 2, "method": "mps", "dimension": 2, "ground": {},
  "bodies": [{"shape": {"type": "box", "center": [0, 0.25], "size": [0.4, 0.5]}}],
  "numerics": {"spacing": 0.05, "cohesion": 20, "erosion": true, "erodible_thickness": 0.1,
               "threads": 1},
  "events": {"count": 2, "max_time": 1}, "output": {"energy": true}})";

/// Grains of eight voxels each, see `write_labels`.
const char* const loaded_grains = R"({"snowshed": 2, "method": "grains", "dimension": 3,
  "sample": {"file": "small.npy", "voxel_size": 1e-4}, "gravity": 0,
  "loading": [{"kind": "compress", "speed": 0.1, "strain": 0.01}], "numerics": {"threads": 1},
  "output": {"energy": true}})";

/// A slide on the plane of `write_terrain`.
const char* const small_slide = R"({"snowshed": 2, "method": "slide", "dimension": 3,
  "terrain": {"file": "plane.asc",
    "release": [{"outline": [[8, 8], [20, 8], [20, 20], [8, 20]], "thickness": 0.5}],
    "entrainment": [{"outline": [[20, 8], [30, 8], [30, 20]], "thickness": 0.2}]},
  "numerics": {"cell": 2, "threads": 1}, "events": {"max_time": 10}})";

std::string rich_scene_in(int dimension) {
  const std::string scene =
      std::regex_replace(rich_scene, std::regex("%D"), std::to_string(dimension));
  return std::regex_replace(scene, std::regex("Y\\(([^)]*)\\)"), dimension == 3 ? "$1," : "");
}

void write_scenes(const fs::path& folder) {
  for (const std::string& name : scene::scene_preset_names())
    write(folder / (name + ".json"), write_scene(scene::preset_scene(name)));
  for (const int dimension : {2, 3})
    write(folder / ("rich-" + std::to_string(dimension) + "d.json"),
          scene::write_scene(scene::parse_scene(rich_scene_in(dimension))));
  write(folder / "grains.json", scene::write_scene(scene::parse_scene(grains_scene)));
  write(folder / "mps.json", scene::write_scene(scene::parse_scene(mps_scene)));
  write(folder / "slide.json", scene::write_scene(scene::parse_scene(slide_scene)));
  write(folder / "least.json", R"({"snowshed": 2, "bodies": [{"shape": {"type": "sphere",)"
                               R"( "center": [0, 0, 1], "radius": 1e-1}}]})");
}

/// Returns the keys and choices of a scene, quoted as in JSON.
std::set<std::string> scene_words() {
  std::set<std::string> words;
  const auto collect_words = [&](const auto& self, const nlohmann::json& node) -> void {
    for (const auto& [key, value] : node.items()) {
      if (key == "properties")
        for (const auto& [name, property] : value.items()) words.insert("\"" + name + "\"");
      if (key == "enum" || key == "const")
        for (const auto& choice : value.is_array() ? value : nlohmann::json::array({value}))
          words.insert(choice.dump());
      if (value.is_structured()) self(self, value);
    }
  };
  collect_words(collect_words, nlohmann::json::parse(scene::scene_schema()));
  return words;
}

const std::vector<std::string> extreme_numbers = {
    "1e308",  "1e999", "-1e-308", "1e-160",      "nan",        "inf",
    "-1",     "0",     "256",     "-2147483649", "4294967295", "18446744073709551616",
    "1.25e3", "0.5"};

void write_dictionary(const fs::path& file, std::set<std::string> words) {
  words.insert(extreme_numbers.begin(), extreme_numbers.end());
  std::string lines;  // libFuzzer's format: a quoted word a line, with hexadecimal escapes
  for (const std::string& word : words)
    lines += std::regex_replace(nlohmann::json(word).dump(), std::regex("\\\\n"), "\\x0A") + "\n";
  write(file, lines);
}

void write_dictionaries(const fs::path& folder) {
  std::set<std::string> words = scene_words();
  words.insert({"null", "true", "false", "\\ud800", "[[["});
  write_dictionary(folder / "scene.dict", words);
  write_dictionary(folder / "checkpoint.dict", words);
  write_dictionary(folder / "obj.dict",
                   {"v ", "vn ", "f ", "\nv 1 1 1\n", "\nf 1 2 3\n", "//", "/1"});
  write_dictionary(folder / "stl.dict", {"solid", "facet normal", "outer loop", "vertex ",
                                         "endloop", "endfacet", "endsolid"});
  write_dictionary(folder / "ply.dict", {"ply",
                                         "format ascii 1.0",
                                         "format binary_little_endian 1.0",
                                         "comment",
                                         "format binary_big_endian 1.0",
                                         "element vertex ",
                                         "element face ",
                                         "property ",
                                         "property list uchar int vertex_indices",
                                         "char",
                                         "uchar",
                                         "short",
                                         "ushort",
                                         "int",
                                         "uint",
                                         "float",
                                         "double",
                                         "vertex_index",
                                         "end_header\n",
                                         "obj_info"});
  write_dictionary(folder / "npy.dict",
                   {"'descr': ", "'<f4'", "'<f8'", "'>f4'", "'fortran_order': ", "False", "True",
                    "'shape': ", "(2, 2, 2), ", "(3, 3), "});
  write_dictionary(folder / "labels.dict",
                   {"'descr': ", "'|u1'", "'<i2'", "'<u8'", "'fortran_order': ", "False", "True",
                    "'shape': ", "(2, 2, 2), "});
  write_dictionary(folder / "asc.dict",
                   {"ncols ", "nrows ", "xllcenter ", "yllcenter ", "xllcorner ", "yllcorner ",
                    "cellsize ", "nodata_value ", "-9999", "NODATA_value nan"});
  write_dictionary(folder / "film.dict",
                   {"axes", "xz", "xyz", "quantum_m", "interval_s", "share", "radius", "true",
                    "false", "quantities", "name", "unit", "meaning", "step", "FRAM"});
}

using Corner = std::array<float, 3>;
const std::vector<Corner> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::array<std::int32_t, 3>> faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

std::string text_of(const Corner& c) {
  return std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
}

void write_stl(const fs::path& folder) {
  std::string ascii = "solid tetrahedron\n", binary(80, ' ');
  binary += raw<std::uint32_t>({std::uint32_t(faces.size())});
  for (const auto& face : faces) {
    ascii += "facet normal 0 0 0\n outer loop\n";
    binary += raw<float>({0, 0, 0});
    for (const std::int32_t i : face) {
      ascii += "  vertex " + text_of(corners[i]) + "\n";
      binary += raw<float>({corners[i].begin(), corners[i].end()});
    }
    ascii += " endloop\nendfacet\n";
    binary += std::string(2, '\0');
  }
  write(folder / "ascii.stl", ascii + "endsolid tetrahedron\n");
  write(folder / "binary.stl", binary);
}

void write_obj(const fs::path& folder) {
  std::string absolute, relative;
  for (const Corner& c : corners) absolute += "v " + text_of(c) + "\n";
  relative = absolute;
  for (const auto& face : faces) {
    absolute += "f";
    relative += "f";
    for (const std::int32_t i : face) {
      absolute += " " + std::to_string(i + 1) + "/1/1";
      relative += " " + std::to_string(i - 4);
    }
    absolute += "\n";
    relative += "\n";
  }
  write(folder / "absolute.obj", "# a comment\nvn 0 0 1\n" + absolute);
  write(folder / "relative.obj", relative);
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment seed\nelement vertex 4\nproperty float x\n" +
         "property float y\nproperty float z\nelement face 4\n" +
         "property list uchar int vertex_indices\nend_header\n";
}

template <class Number>
std::string big_endian(Number number) {
  std::string bytes = raw<Number>({number});
  return {bytes.rbegin(), bytes.rend()};
}

void write_ply(const fs::path& folder) {
  std::string ascii = ply_header("ascii"), little = ply_header("binary_little_endian"),
              big = ply_header("binary_big_endian");
  for (const Corner& c : corners) {
    ascii += text_of(c) + "\n";
    for (const float x : c) little += raw<float>({x}), big += big_endian(x);
  }
  for (const auto& face : faces) {
    ascii += "3", little += '\3', big += '\3';
    for (const std::int32_t i : face) {
      ascii += " " + std::to_string(i);
      little += raw<std::int32_t>({i}), big += big_endian(i);
    }
    ascii += "\n";
  }
  write(folder / "ascii.ply", ascii);
  write(folder / "little.ply", little);
  write(folder / "big.ply", big);
}

std::string npy(const std::string& version, const std::string& type, const std::string& shape) {
  const std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::string length(1, static_cast<char>(header.size()));
  length.resize(version[0] == '\1' ? 2 : 4, '\0');
  return "\x93NUMPY" + version + length + header;
}

void write_npy(const fs::path& folder) {
  using namespace std::string_literals;
  const std::vector<float> flat = {0.05f, 0.05f, 0.05f, 0.05f, -0.05f, 0.05f, 0.05f, 0.05f, 0.05f};
  const std::vector<double> deep = {0.05, -0.05, 0.05, -0.05, 0.05, -0.05, 0.05, -0.05};
  write(folder / "flat.npy", npy("\1\0"s, "<f4", "(3, 3)") + raw(flat));
  write(folder / "deep.npy", npy("\2\0"s, "<f8", "(2, 2, 2)") + raw(deep));
}

void write_labels(const fs::path& folder) {
  using namespace std::string_literals;
  const std::vector<std::uint8_t> small = {0, 1, 1, 2, 0, 2, 2, 3};
  const std::vector<std::int64_t> wide(small.begin(), small.end());
  write(folder / "small.npy", npy("\1\0"s, "|u1", "(2, 2, 2)") + raw(small));
  write(folder / "wide.npy", npy("\2\0"s, "<i8", "(2, 2, 2)") + raw(wide));
}

void write_rasters(const fs::path& folder) {
  const std::string size = "ncols 3\nnrows 2\n", values = "1 2.5 -9999\n4e1 5 6\n";
  write(folder / "centre.asc", size + "xllcenter 10\nyllcenter 20\ncellsize 5\n" + values);
  write(folder / "corner.asc",
        size + "xllcorner 1\nyllcorner 2\ncellsize 0.5\nnodata_value nan\n1 nan 3\n4 5 6\n");
}

/// Writes the elevations of a plane inclined by 38 degrees.
void write_terrain(const fs::path& file) {
  std::string heights = "ncols 20\nnrows 15\nxllcenter 0\nyllcenter 0\ncellsize 2\n";
  for (int row = 0; row < 15; ++row)
    for (int column = 0; column < 20; ++column)
      heights += std::to_string(100 - 1.5626 * column) + (column < 19 ? " " : "\n");
  write(file, heights);
}

/// Writes films of particles that appear, move and vanish.
void write_films(const fs::path& folder) {
  fs::create_directories(folder);
  for (const int axes : {2, 3}) {
    io::FilmHeader header;
    header.axes = axes;
    header.quantum = 1.0 / 1024;
    header.interval = 0.1;
    header.has_radius = axes == 3;
    header.quantities = {{"speed", "m/s", "Speed", 0.05}};
    io::FilmWriter writer(folder / (std::to_string(axes) + "d.bin"), header);
    for (std::uint32_t k = 0; k < 4; ++k) {
      io::FilmFrame frame;
      frame.time = 0.1 * k;
      frame.event = 1 + k / 3;
      frame.positions.resize(std::size_t(axes));
      frame.values.resize(1);
      for (std::uint32_t id = k / 3; id < 4 + k / 2; ++id) {
        frame.ids.push_back(id);
        frame.events.push_back(std::uint16_t(1));
        frame.materials.push_back(std::uint8_t(id % 2));
        if (header.has_radius) frame.radii.push_back(std::int32_t(id));
        for (auto& axis : frame.positions) axis.push_back(std::int32_t(10 * id + k * k));
        frame.values[0].push_back(std::int32_t(k));
      }
      writer.append(frame);
    }
  }
}

/// Returns a scene of a few particles: plain and between two events, or with many features and in
/// the middle of an event.
scene::Scene scene_of_checkpoint(int dimension, bool running) {
  scene::Scene scene =
      scene::parse_scene(R"({"snowshed": 2, "bodies": [{"shape": {"type": "sphere", "center":)"
                         R"( [0, 0, 0.25], "radius": 0.1}, "event": 0}], "ground": {},)"
                         R"( "events": {"count": 2}, "numerics": {"dx": 0.1, "threads": 1}})");
  scene.dimension = dimension;
  scene.events.max_time = running ? 1.0 : 0.01;
  scene.events.rest_time = 0.005;
  if (!running) return scene;
  scene.events.between = methods::Between::reseed;
  scene.numerics.as<methods::mpm::Settings>().precision = methods::mpm::Precision::float64;
  scene.numerics.as<methods::mpm::Settings>().transfer = methods::mpm::Transfer::apic;
  scene.output.energy = true;
  scene.domain.emplace(scene::Domain{Vec3(-1, -1, -1), Vec3(1, 1, 1)});
  scene::ObstacleSpec plate;
  plate.shape = scene.bodies.front().shape;
  plate.shape.center.z() = 0;
  plate.motion.emplace();
  plate.motion->velocity.z() = 0.1;
  scene.obstacles.push_back(plate);
  return scene;
}

/// Writes the checkpoint of a scene after some steps of its first event.
void write_checkpoint(const scene::Scene& scene, const fs::path& inputs, const fs::path& file) {
  run::Simulation simulation(scene, inputs);
  simulation.begin_event();
  simulation.step(3);
  simulation.save(file);
}

/// Writes a checkpoint of each other method, with a state that has all parts, and writes the files
/// that the scenes name into `inputs`.
void write_checkpoints_of_methods(const fs::path& folder, const fs::path& inputs) {
  write_terrain(inputs / "plane.asc");
  write_labels(inputs);
  write_checkpoint(scene::parse_scene(mps_scene), inputs, folder / "mps");
  write_checkpoint(scene::parse_scene(loaded_grains), inputs, folder / "grains");
  write_checkpoint(scene::parse_scene(small_slide), inputs, folder / "slide");
}

void write_checkpoints(const fs::path& folder) {
  fs::create_directories(folder);
  for (const int dimension : {2, 3})
    for (const bool running : {false, true}) {
      run::Simulation simulation(scene_of_checkpoint(dimension, running));
      simulation.begin_event();
      simulation.run([&](const run::RunReport& r) { return !running || r.steps < 10; }, 0.0);
      simulation.save(folder / (std::to_string(dimension) + (running ? "d-running" : "d-ended")));
    }
}

void write_seeds(const fs::path& folder) {
  write_scenes(folder / "scene");
  write_dictionaries(folder);
  write_stl(folder / "stl");
  write_obj(folder / "obj");
  write_ply(folder / "ply");
  write_npy(folder / "npy");
  write_labels(folder / "labels");
  write_rasters(folder / "asc");
  write_films(folder / "film");
  write_checkpoints(folder / "checkpoint");
  write_checkpoints_of_methods(folder / "checkpoint", fs::absolute(folder / "inputs"));
}

}  // namespace
}  // namespace snowshed

int main(int count, char** arguments) {
  if (count != 2) return 2;
  snowshed::write_seeds(arguments[1]);
  return 0;
}
