// Sources that are compiled for a graphics card while the program runs. The build puts their text
// into the library, so that a run reads no file; cmake/EmbeddedSources.cmake chooses them.
#pragma once

#include <vector>

namespace snowshed::gpu {

/// A source file: its name in includes, and its text.
struct SourceText {
  const char *name, *text;
};

/// The kernels, the headers of the core that they share, and the stand-ins for other headers.
const std::vector<SourceText>& embedded_sources();

}  // namespace snowshed::gpu
