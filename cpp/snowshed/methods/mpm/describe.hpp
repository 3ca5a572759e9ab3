// The form of the settings of the material point method, and the names of their enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/settings_visitor.hpp"

namespace snowshed {

template <>
struct EnumNames<Precision> {
  static constexpr Named<Precision> list[] = {{Precision::float32, "float"},
                                              {Precision::float64, "double"}};
};

template <>
struct EnumNames<Transfer> {
  static constexpr Named<Transfer> list[] = {{Transfer::flip, "flip"}, {Transfer::apic, "apic"}};
};

template <>
struct EnumNames<Basis> {
  static constexpr Named<Basis> list[] = {{Basis::quadratic, "quadratic"}, {Basis::cubic, "cubic"}};
};

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, MpmSettings&);

}  // namespace snowshed
