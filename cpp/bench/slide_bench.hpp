// Benchmarks of the snow slide.
#pragma once

namespace snowshed {

void add_slides();

}  // namespace snowshed
