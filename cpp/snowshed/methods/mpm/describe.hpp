// The form of the settings of the material point method, and the names of their enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/mpm/settings.hpp"
#include "snowshed/methods/settings_visitor.hpp"
#include "snowshed/methods/unused_settings.hpp"

namespace snowshed::methods {

template <>
struct EnumNames<mpm::Precision> {
  static constexpr Named<mpm::Precision> list[] = {{mpm::Precision::float32, "float"},
                                                   {mpm::Precision::float64, "double"}};
};

template <>
struct EnumNames<mpm::Transfer> {
  static constexpr Named<mpm::Transfer> list[] = {{mpm::Transfer::flip, "flip"},
                                                  {mpm::Transfer::apic, "apic"},
                                                  {mpm::Transfer::affine_flip, "affine_flip"}};
};

template <>
struct EnumNames<mpm::ContactRule> {
  static constexpr Named<mpm::ContactRule> list[] = {{mpm::ContactRule::kernel, "kernel"},
                                                     {mpm::ContactRule::touch, "touch"}};
};

template <>
struct EnumNames<mpm::Fields> {
  static constexpr Named<mpm::Fields> list[] = {{mpm::Fields::one, "one"},
                                                {mpm::Fields::events, "events"}};
};

template <>
struct EnumNames<mpm::Scheme> {
  static constexpr Named<mpm::Scheme> list[] = {{mpm::Scheme::thesis, "thesis"},
                                                {mpm::Scheme::objective, "objective"}};
};

template <>
struct EnumNames<mpm::DeviceSetting> {
  static constexpr Named<mpm::DeviceSetting> list[] = {{mpm::DeviceSetting::cpu, "cpu"},
                                                       {mpm::DeviceSetting::gpu, "gpu"},
                                                       {mpm::DeviceSetting::automatic, "auto"}};
};

template <>
struct EnumNames<mpm::Basis> {
  static constexpr Named<mpm::Basis> list[] = {{mpm::Basis::quadratic, "quadratic"},
                                               {mpm::Basis::cubic, "cubic"}};
};

}  // namespace snowshed::methods

namespace snowshed::methods::mpm {

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, Settings&);

/// Settings that the others leave without effect.
std::vector<UnusedSettings> unused_settings(const Settings&);

}  // namespace snowshed::methods::mpm
