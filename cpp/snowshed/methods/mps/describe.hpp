// The form of the settings of the moving particle semi-implicit method, and the names of their
// enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/settings_visitor.hpp"
#include "snowshed/methods/unused_settings.hpp"

namespace snowshed::methods {

template <>
struct EnumNames<mps::ShearLaw> {
  static constexpr Named<mps::ShearLaw> list[] = {
      {mps::ShearLaw::newtonian, "newtonian"},
      {mps::ShearLaw::bingham, "bingham"},
      {mps::ShearLaw::bingham_dilatant, "bingham_dilatant"}};
};

template <>
struct EnumNames<mps::Regularisation> {
  static constexpr Named<mps::Regularisation> list[] = {
      {mps::Regularisation::papanastasiou, "papanastasiou"},
      {mps::Regularisation::bi_viscous, "bi_viscous"}};
};

template <>
struct EnumNames<mps::Walls> {
  static constexpr Named<mps::Walls> list[] = {{mps::Walls::mirrors, "mirrors"},
                                               {mps::Walls::particles, "particles"}};
};

template <>
struct EnumNames<mps::Stress> {
  static constexpr Named<mps::Stress> list[] = {{mps::Stress::published, "published"},
                                                {mps::Stress::elastoplastic, "elastoplastic"}};
};

template <>
struct EnumNames<mps::Source> {
  static constexpr Named<mps::Source> list[] = {{mps::Source::published, "published"},
                                                {mps::Source::compensated, "compensated"}};
};

template <>
struct EnumNames<mps::Gradient> {
  static constexpr Named<mps::Gradient> list[] = {{mps::Gradient::published, "published"},
                                                  {mps::Gradient::conservative, "conservative"},
                                                  {mps::Gradient::corrected, "corrected"}};
};

template <>
struct EnumNames<mps::Coupling> {
  static constexpr Named<mps::Coupling> list[] = {{mps::Coupling::none, "none"},
                                                  {mps::Coupling::stiff, "stiff"},
                                                  {mps::Coupling::always, "always"}};
};

template <>
struct EnumNames<mps::Splitting> {
  static constexpr Named<mps::Splitting> list[] = {
      {mps::Splitting::viscosity_first, "viscosity_first"},
      {mps::Splitting::pressure_first, "pressure_first"}};
};

template <>
struct EnumNames<mps::Surface> {
  static constexpr Named<mps::Surface> list[] = {{mps::Surface::published, "published"},
                                                 {mps::Surface::mirrored, "mirrored"}};
};

template <>
struct EnumNames<mps::Order> {
  static constexpr Named<mps::Order> list[] = {{mps::Order::published, "published"},
                                               {mps::Order::single_move, "single_move"}};
};

template <>
struct EnumNames<mps::SpacingLaw> {
  static constexpr Named<mps::SpacingLaw> list[] = {{mps::SpacingLaw::none, "none"},
                                                    {mps::SpacingLaw::collision, "collision"},
                                                    {mps::SpacingLaw::shifting, "shifting"}};
};

template <>
struct EnumNames<mps::Preconditioner> {
  static constexpr Named<mps::Preconditioner> list[] = {
      {mps::Preconditioner::jacobi, "jacobi"},
      {mps::Preconditioner::incomplete_cholesky, "incomplete_cholesky"},
      {mps::Preconditioner::multigrid, "multigrid"}};
};

}  // namespace snowshed::methods

namespace snowshed::methods::mps {

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, Settings&);

/// Settings that the others leave without effect.
std::vector<UnusedSettings> unused_settings(const Settings&);

}  // namespace snowshed::methods::mps
