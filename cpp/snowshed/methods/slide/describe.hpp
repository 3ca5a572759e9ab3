// The form of the settings of the snow slide, and the names of their enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/scene_parts.hpp"
#include "snowshed/methods/settings_visitor.hpp"
#include "snowshed/methods/slide/settings.hpp"
#include "snowshed/methods/unused_settings.hpp"

namespace snowshed::methods {

template <>
struct EnumNames<slide::Mode> {
  static constexpr Named<slide::Mode> list[] = {{slide::Mode::improved, "improved"},
                                                {slide::Mode::compatible, "compatible"}};
};

template <>
struct EnumNames<slide::Columns> {
  static constexpr Named<slide::Columns> list[] = {{slide::Columns::vertical, "vertical"},
                                                   {slide::Columns::across_flow, "across_flow"}};
};

template <>
struct EnumNames<slide::FrictionLaw> {
  static constexpr Named<slide::FrictionLaw> list[] = {{slide::FrictionLaw::voellmy, "voellmy"},
                                                       {slide::FrictionLaw::coulomb, "coulomb"}};
};

}  // namespace snowshed::methods

namespace snowshed::methods::slide {

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, Settings&);

/// Settings that the others or the terrain leave without effect.
std::vector<UnusedSettings> unused_settings(const Settings&, const TerrainSpec&);

}  // namespace snowshed::methods::slide
