// Records a run as a film: the particles at even intervals, from which the view is made.
#pragma once

#include <filesystem>
#include <optional>

#include "snowshed/io/film_file.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/run/cost_estimate.hpp"

namespace snowshed {

/// Progress of a run.
struct RunPosition {
  int event = 0;
  bool running = false;
  double time = 0;  // s, through all events
};

/// Chooses the contents of a run's film: of at most about `max_particles` particles, some, chosen
/// by their ids; positions to a 16th of the resolution (with radii: to a 128th of the smallest),
/// and to half a millimetre at least; frames at the `record_interval`.
FilmHeader film_header(const Scene&, const Method&, const CostEstimate&);

class FilmRecorder {
 public:
  static constexpr double max_particles = 40000;

  /// Begins a film, or continues after the frames that a run had recorded up to `place`, so that a
  /// resumed run makes the same film. `mark` is that of the film then, where it is known. Throws
  /// InputError if the film is damaged.
  FilmRecorder(const std::filesystem::path& file, const FilmHeader& header,
               const RunPosition& place, const std::optional<FilmMark>& mark);

  /// Whether the first frame of an event is missing, or the next one's time has come.
  bool due(const RunPosition&) const;
  void record(const Method&, int event);
  /// The last frame of an event, unless it is recorded already.
  void record_end(const Method&, int event);
  /// Says that no frame will follow.
  void close() { film_.close(); }
  FilmMark mark() const { return film_.mark(); }

 private:
  bool begun(int event) const;
  double next_time() const;

  FilmWriter film_;
};

}  // namespace snowshed
