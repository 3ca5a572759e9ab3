// Where the energy went.
#pragma once

namespace snowshed {

/// Energy books, J (per metre of width in 2D). The first three are the present store; the others
/// are sums over all steps of what left it. `residual` is what the time integration gained (> 0)
/// or lost: the books close when it is small beside the rest.
struct EnergyBalance {
  double kinetic = 0, gravitational = 0, elastic = 0;
  double plastic = 0, friction = 0, sticking = 0, impact = 0, transfer = 0;
  double sleep = 0;  // motion that snow lost as it fell asleep
  double added = 0;  // brought by particles that were added

  double stored() const { return kinetic + gravitational + elastic; }
  double spent() const { return plastic + friction + sticking + impact + transfer + sleep; }
  double residual() const { return stored() + spent() - added; }
};

}  // namespace snowshed
