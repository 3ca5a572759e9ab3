// The form of the settings of the moving particle semi-implicit method, and the names of their
// enumerations.
#pragma once

#include "snowshed/methods/enum_names.hpp"
#include "snowshed/methods/mps/settings.hpp"
#include "snowshed/methods/settings_visitor.hpp"

namespace snowshed {

template <>
struct EnumNames<MpsRheology> {
  static constexpr Named<MpsRheology> list[] = {
      {MpsRheology::newtonian, "newtonian"},
      {MpsRheology::bingham, "bingham"},
      {MpsRheology::bingham_dilatant, "bingham_dilatant"}};
};

template <>
struct EnumNames<MpsYield> {
  static constexpr Named<MpsYield> list[] = {{MpsYield::papanastasiou, "papanastasiou"},
                                             {MpsYield::bi_viscous, "bi_viscous"}};
};

template <>
struct EnumNames<MpsWalls> {
  static constexpr Named<MpsWalls> list[] = {{MpsWalls::mirrors, "mirrors"},
                                             {MpsWalls::particles, "particles"}};
};

template <>
struct EnumNames<MpsSource> {
  static constexpr Named<MpsSource> list[] = {{MpsSource::published, "published"},
                                              {MpsSource::compensated, "compensated"}};
};

template <>
struct EnumNames<MpsGradient> {
  static constexpr Named<MpsGradient> list[] = {{MpsGradient::published, "published"},
                                                {MpsGradient::conservative, "conservative"},
                                                {MpsGradient::corrected, "corrected"}};
};

template <>
struct EnumNames<MpsCoupling> {
  static constexpr Named<MpsCoupling> list[] = {
      {MpsCoupling::none, "none"}, {MpsCoupling::stiff, "stiff"}, {MpsCoupling::always, "always"}};
};

template <>
struct EnumNames<MpsSplitting> {
  static constexpr Named<MpsSplitting> list[] = {{MpsSplitting::viscosity_first, "viscosity_first"},
                                                 {MpsSplitting::pressure_first, "pressure_first"}};
};

template <>
struct EnumNames<MpsSurface> {
  static constexpr Named<MpsSurface> list[] = {{MpsSurface::published, "published"},
                                               {MpsSurface::mirrored, "mirrored"}};
};

template <>
struct EnumNames<MpsOrder> {
  static constexpr Named<MpsOrder> list[] = {{MpsOrder::published, "published"},
                                             {MpsOrder::single_move, "single_move"}};
};

template <>
struct EnumNames<MpsSpacing> {
  static constexpr Named<MpsSpacing> list[] = {{MpsSpacing::none, "none"},
                                               {MpsSpacing::collision, "collision"},
                                               {MpsSpacing::shifting, "shifting"}};
};

template <>
struct EnumNames<MpsPreconditioner> {
  static constexpr Named<MpsPreconditioner> list[] = {
      {MpsPreconditioner::jacobi, "jacobi"},
      {MpsPreconditioner::incomplete_cholesky, "incomplete_cholesky"},
      {MpsPreconditioner::multigrid, "multigrid"}};
};

/// Shows a visitor each setting in turn: key, unit, range and meaning.
void describe(SettingsVisitor&, MpsSettings&);

}  // namespace snowshed
