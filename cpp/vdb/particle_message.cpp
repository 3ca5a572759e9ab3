#include "particle_message.hpp"

#include <nlohmann/json.hpp>

#include "snowshed/core/errors.hpp"
#include "snowshed/sampling/particle_voxels.hpp"
#include "snowshed/sampling/seeding.hpp"

namespace snowshed {
namespace {

template <class T>
std::vector<T> read_values(std::istream& in, std::size_t count) {
  std::vector<T> values(count);
  if (!in.read(reinterpret_cast<char*>(values.data()), std::streamsize(count * sizeof(T))))
    throw InputError("", "the particles end too early");
  return values;
}

io::PointArray read_attribute(std::istream& in, const nlohmann::json& header,
                              std::size_t particles) {
  io::PointArray array;
  array.name = header.at(0);
  array.components = header.at(2);
  if (array.components != 1 && array.components != 3)
    throw InputError(array.name, "1 or 3 components are allowed");
  const std::size_t count = particles * std::size_t(array.components);
  if (header.at(1) == "float32")
    array.values = read_values<float>(in, count);
  else if (header.at(1) == "int32" && array.components == 1)
    array.values = read_values<std::int32_t>(in, count);
  else
    throw InputError(array.name, "float32, or one int32 for each particle, is allowed");
  return array;
}

}  // namespace

WriteRequest read_request(std::istream& in) try {
  std::string line;
  std::getline(in, line);
  const auto header = nlohmann::json::parse(line);
  WriteRequest request;
  request.settings.dimension = header.at("dimension");
  request.settings.voxel = header.at("voxel");
  request.settings.width = header.at("width");
  request.settings.radius = sampling::particle_radius(
      request.settings.dimension, request.settings.voxel, header.at("particles_per_voxel"));
  const std::size_t particles = header.at("particles");
  if (double(particles) > sampling::max_particles)
    throw InputError("particles", "at most 2e8 are written");
  const std::vector<double> x = read_values<double>(in, 3 * particles);
  for (std::size_t n = 0; n < particles; ++n)
    request.cloud.positions.emplace_back(
        x[3 * n], request.settings.dimension == 2 ? 0.0 : x[3 * n + 1], x[3 * n + 2]);
  request.cloud.masses = read_values<double>(in, particles);
  for (const auto& attribute : header.at("attributes"))
    request.cloud.attributes.push_back(read_attribute(in, attribute, particles));
  return request;
} catch (const nlohmann::json::exception& error) {
  throw InputError("", std::string("not a description of particles: ") + error.what());
}

}  // namespace snowshed
