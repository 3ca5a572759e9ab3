// All kernels of the material point method on a graphics card, without the balance of energy. The
// course of a simulation there is told in docs/develop/gpu.md.
#pragma once

#include "snowshed/methods/mpm/gpu/events.cuh"
#include "snowshed/methods/mpm/gpu/forces.cuh"
#include "snowshed/methods/mpm/gpu/node_step.cuh"
#include "snowshed/methods/mpm/gpu/overlap_step.cuh"
#include "snowshed/methods/mpm/gpu/particle_step.cuh"
#include "snowshed/methods/mpm/gpu/probe.cuh"
#include "snowshed/methods/mpm/gpu/sleep.cuh"
#include "snowshed/methods/mpm/gpu/sort.cuh"
