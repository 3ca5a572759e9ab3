// The program snowshed-run: it runs a JSON scene and writes its results.
#pragma once

namespace snowshed::run {

/// Runs the program with these arguments, the first its name, and returns its exit code. Signals
/// end the run at its next safe point.
int run_program(int argc, char** argv);

}  // namespace snowshed::run
