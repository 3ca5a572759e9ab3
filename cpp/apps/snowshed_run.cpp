// snowshed-run: runs a JSON scene and writes its results, without Python.
#include "snowshed/run/program.hpp"

int main(int argc, char** argv) { return snowshed::run::run_program(argc, argv); }
