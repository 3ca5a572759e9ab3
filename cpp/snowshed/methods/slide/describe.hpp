// The form of the settings of the snow slide, and the names of their enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/settings_visitor.hpp"
#include "snowshed/methods/slide/settings.hpp"

namespace snowshed {

template <>
struct EnumNames<SlideMode> {
  static constexpr Named<SlideMode> list[] = {{SlideMode::improved, "improved"},
                                              {SlideMode::compatible, "compatible"}};
};

template <>
struct EnumNames<SlideFriction> {
  static constexpr Named<SlideFriction> list[] = {{SlideFriction::voellmy, "voellmy"},
                                                  {SlideFriction::coulomb, "coulomb"}};
};

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, SlideSettings&);

}  // namespace snowshed
