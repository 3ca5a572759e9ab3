// Surroundings of the snow in a scene, built once: solids, a method's input files, the device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/device_choice.hpp"
#include "snowshed/methods/obstacle.hpp"
#include "snowshed/methods/user_laws.hpp"

namespace snowshed::methods {

/// A file that a scene names, and the fingerprint of its contents.
struct FileFingerprint {
  std::string file;
  std::int64_t fingerprint;
};

/// Input that a method read from files of its own.
class MethodInput {
 public:
  virtual ~MethodInput() = default;

  /// The section of a checkpoint that holds the fingerprints of these files.
  virtual const char* section() const = 0;
  virtual std::vector<FileFingerprint> files() const = 0;
  /// A note on the files, which the user reads before the run; empty if there is none.
  virtual std::string note() const { return ""; }
};

struct Surroundings {
  std::vector<material::Snow> snows;         // indexed by material_id
  std::vector<Obstacle> obstacles;           // all of them, as they are given
  std::vector<Obstacle> resolved;            // the same, thickened to the method's resolution
  std::vector<std::string> notes;            // assumptions and changes, a sentence each
  UserLaws laws;                             // the user's; the obstacles have theirs
  std::shared_ptr<const MethodInput> input;  // null if the method reads no files
  DeviceChoice device;                       // on which the method shall run
};

}  // namespace snowshed::methods
