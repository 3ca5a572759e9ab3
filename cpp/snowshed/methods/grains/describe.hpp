// The form of the settings of the discrete elements of snow, and the names of their enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/grains/settings.hpp"
#include "snowshed/methods/settings_visitor.hpp"

namespace snowshed::methods {

template <>
struct EnumNames<grains::Sides> {
  static constexpr Named<grains::Sides> list[] = {{grains::Sides::walls, "walls"},
                                                  {grains::Sides::periodic, "periodic"}};
};

}  // namespace snowshed::methods

namespace snowshed::methods::grains {

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, Settings&);

}  // namespace snowshed::methods::grains
