// Methods whose steps are taken where nobody sees them.
#pragma once

namespace snowshed::methods {

/// A method whose `advance` takes many steps on a device, at a much lower price than its steps one
/// by one, after each of which somebody may look.
class AdvancesUnwatched {
 public:
  virtual ~AdvancesUnwatched() = default;
};

}  // namespace snowshed::methods
