// The form of the settings of the discrete elements of snow, and the names of their enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/methods/settings_visitor.hpp"

namespace snowshed {

template <>
struct EnumNames<GrainSides> {
  static constexpr Named<GrainSides> list[] = {{GrainSides::walls, "walls"},
                                               {GrainSides::periodic, "periodic"}};
};

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, GrainsSettings&);

}  // namespace snowshed
