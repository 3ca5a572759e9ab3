// Records a run as a film: the particles at even intervals, from which the view is made.
#pragma once

#include <filesystem>
#include <optional>

#include "snowshed/io/film_file.hpp"
#include "snowshed/methods/method.hpp"
#include "snowshed/run/cost_estimate.hpp"

namespace snowshed::run {

/// Progress of a run.
struct RunPosition {
  int event = 0;
  bool running = false;
  double time = 0;  // s, through all events
};

/// Chooses the contents of a run's film. At most about `max_particles` particles are recorded,
/// chosen by their ids, at the `record_interval`. Positions are accurate to a 16th of the
/// resolution (with radii: to a 128th of the smallest radius), and at least to half a millimetre.
io::FilmHeader film_header(const scene::Scene&, const methods::Method&,
                           const methods::CostEstimate&);

class FilmRecorder {
 public:
  static constexpr double max_particles = 40000;

  /// Begins a film, or continues after the frames that a run had recorded up to `position`, so that
  /// a resumed run makes the same film. `mark` identifies the film at that time, if it is known.
  /// Throws InputError if the film is damaged.
  FilmRecorder(const std::filesystem::path& file, const io::FilmHeader& header,
               const RunPosition& position, const std::optional<io::FilmMark>& mark);

  /// Whether the first frame of an event is missing, or the next one's time has come.
  bool due(const RunPosition&) const;
  /// The time (s) of the next frame of an event that has a first one.
  double next_time() const;
  void record(const methods::Method&, int event);
  /// Records the last frame of an event, unless it has been recorded.
  void record_end(const methods::Method&, int event);
  /// Marks the film as complete: no frame will follow.
  void close() { film_.close(); }
  io::FilmMark mark() const { return film_.mark(); }

 private:
  bool begun(int event) const;

  io::FilmWriter film_;
};

}  // namespace snowshed::run
