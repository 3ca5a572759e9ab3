// The device on which a method runs.
#pragma once

#include <memory>
#include <string>

#include "snowshed/gpu/device.hpp"

namespace snowshed::methods {

/// The device for a run: the card, opened, or none for the processor.
struct DeviceChoice {
  std::shared_ptr<gpu::Device> card;
  std::string note;  // why this device computes, or what is doubtful about it; empty if neither

  bool is_card() const { return card != nullptr; }
  std::string name() const { return card ? card->name() : "cpu"; }
};

}  // namespace snowshed::methods
