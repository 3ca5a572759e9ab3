#include "snowshed/run/film_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "snowshed/core/errors.hpp"
#include "snowshed/methods/quantities.hpp"
#include "snowshed/run/record_times.hpp"

namespace snowshed::run {
namespace {

constexpr double max_quantum = 1.0 / 1024;  // m
constexpr double max_quanta = 1 << 30;

/// The smallest length that matters in a picture, m: an eighth of the smallest radius, or the
/// resolution; zero if a raster sets the resolution.
double smallest_length(const scene::Scene& scene, const methods::Method& method, bool has_radius) {
  if (!has_radius || method.size() == 0) return scene.numerics->resolution();
  const particles::FieldView radii = method.field("equivalent_radius");
  double smallest = *radii.at<double>(0);
  for (std::size_t i = 1; i < radii.count; ++i) smallest = std::min(smallest, *radii.at<double>(i));
  return smallest / 8;  // particles with radii move little
}

/// A power of two, so that positions in single precision are exact.
double quantum_for(double resolution) {
  if (!(resolution > 0)) return max_quantum;
  return std::min(max_quantum, std::exp2(std::floor(std::log2(resolution / 8))));
}

const particles::FieldInfo* find(const std::vector<particles::FieldInfo>& fields,
                                 const std::string& name) {
  const auto field =
      std::find_if(fields.begin(), fields.end(),
                   [&name](const particles::FieldInfo& info) { return info.name == name; });
  return field == fields.end() ? nullptr : &*field;
}

/// Calls convert(i, components) for the values of a field of the chosen particles.
template <class Convert>
void each_value(const particles::FieldView& view, const std::vector<std::uint32_t>& indices,
                Convert convert) {
  particles::with_field_type(view.info.type, [&](auto zero) {
    using T = decltype(zero);
    for (std::size_t i = 0; i < indices.size(); ++i) convert(i, view.at<T>(indices[i]));
  });
}

template <class T>
std::vector<T> integer_values(const methods::Method& method, const std::string& name,
                              const std::vector<std::uint32_t>& indices) {
  std::vector<T> values(indices.size());
  each_value(method.field(name), indices, [&](std::size_t i, const auto* v) { values[i] = T(*v); });
  return values;
}

std::int32_t in_quanta(double metres, double quantum) {
  return std::int32_t(std::lround(std::clamp(metres / quantum, -max_quanta, max_quanta)));
}

/// Returns the indices of the recorded particles, ordered by id; `ids` receives their ids.
std::vector<std::uint32_t> recorded_indices(const methods::Method& method,
                                            const io::FilmHeader& header,
                                            std::vector<std::uint32_t>& ids) {
  const std::vector<std::uint32_t>& order = method.order_by_id();
  const auto all = integer_values<std::uint32_t>(method, "id", order);
  std::vector<std::uint32_t> indices;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (header.records(all[k])) {
      indices.push_back(order[k]);
      ids.push_back(all[k]);
    }
  return indices;
}

std::vector<std::int32_t> codes(const methods::Method& method, const io::FilmQuantity& quantity,
                                const std::vector<std::uint32_t>& indices) {
  std::vector<std::int32_t> values(indices.size());
  const bool speed = quantity.name == "speed";
  each_value(method.field(speed ? "velocity" : quantity.name), indices,
             [&](std::size_t i, const auto* v) {
               values[i] = quantity.code(speed ? std::hypot(v[0], v[1], v[2]) : double(*v));
             });
  return values;
}

io::FilmFrame frame_of(const methods::Method& method, const io::FilmHeader& header, int event) {
  io::FilmFrame frame;
  frame.time = method.time();
  frame.event = std::uint32_t(event);
  const auto indices = recorded_indices(method, header, frame.ids);
  const std::vector<particles::FieldInfo> fields = method.fields();
  frame.events = integer_values<std::uint16_t>(method, "event", indices);
  frame.materials = find(fields, "material_id")
                        ? integer_values<std::uint8_t>(method, "material_id", indices)
                        : std::vector<std::uint8_t>(indices.size());
  if (header.has_radius) {
    frame.radii.resize(indices.size());
    each_value(method.field("equivalent_radius"), indices, [&](std::size_t i, const auto* r) {
      frame.radii[i] = in_quanta(double(*r), header.quantum);
    });
  }
  frame.positions.assign(std::size_t(header.axes), std::vector<std::int32_t>(indices.size()));
  each_value(method.field("position"), indices, [&](std::size_t i, const auto* x) {
    for (int axis = 0; axis < header.axes; ++axis)
      frame.positions[std::size_t(axis)][i] =
          in_quanta(double(x[header.axes == 2 ? 2 * axis : axis]), header.quantum);
  });
  for (const io::FilmQuantity& quantity : header.quantities)
    frame.values.push_back(codes(method, quantity, indices));
  return frame;
}

io::FilmWriter open_film(const std::filesystem::path& file, const io::FilmHeader& header,
                         const RunPosition& position, const std::optional<io::FilmMark>& mark) {
  if (!std::filesystem::exists(file)) return io::FilmWriter(file, header);
  const auto keeps = [&position](const io::FilmFrameInfo& frame) {
    const int event = int(frame.event);
    if (event != position.event) return event < position.event;
    return !position.running || frame.time < position.time;
  };
  try {
    return io::FilmWriter::reopen(file, keeps, mark);
  } catch (const InputError& error) {
    throw InputError(error.what(),
                     "restore the file, or remove it: the film then begins where the run resumes");
  }
}

}  // namespace

io::FilmHeader film_header(const scene::Scene& scene, const methods::Method& method,
                           const methods::CostEstimate& cost) {
  io::FilmHeader header;
  header.axes = scene.dimension;
  header.interval = record_interval(scene, cost);
  header.share = std::min(1.0, FilmRecorder::max_particles / std::max(cost.total_particles, 1.0));
  const std::vector<particles::FieldInfo> fields = method.fields();
  header.has_radius = find(fields, "equivalent_radius") != nullptr;
  header.quantum = quantum_for(smallest_length(scene, method, header.has_radius));
  for (const methods::Quantity& q : methods::quantities())
    if (q.film_step > 0 && find(fields, q.name == "speed" ? "velocity" : q.name))
      header.quantities.push_back({q.name, q.unit, q.meaning, q.film_step});
  return header;
}

FilmRecorder::FilmRecorder(const std::filesystem::path& file, const io::FilmHeader& header,
                           const RunPosition& position, const std::optional<io::FilmMark>& mark)
    : film_(open_film(file, header, position, mark)) {}

bool FilmRecorder::begun(int event) const {
  return !film_.frames().empty() && int(film_.frames().back().event) == event;
}

double FilmRecorder::next_time() const {
  const std::vector<io::FilmFrameInfo>& frames = film_.frames();
  auto first = frames.end() - 1;
  while (first != frames.begin() && (first - 1)->event == frames.back().event) --first;
  return next_record_time(first->time, frames.back().time, std::size_t(frames.end() - first),
                          film_.header().interval);
}

bool FilmRecorder::due(const RunPosition& position) const {
  return !begun(position.event) || position.time >= next_time();
}

void FilmRecorder::record(const methods::Method& method, int event) {
  film_.append(frame_of(method, film_.header(), event));
}

void FilmRecorder::record_end(const methods::Method& method, int event) {
  if (!begun(event) || film_.frames().back().time < method.time()) record(method, event);
}

}  // namespace snowshed::run
