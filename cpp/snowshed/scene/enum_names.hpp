// The words that stand for the scene's enumerations, in JSON and in messages.
#pragma once

#include "snowshed/scene/scene.hpp"

namespace snowshed {

template <class E>
struct Named {
  E value;
  const char* name;
};

/// `EnumNames<E>::list` holds every value of E with its name.
template <class E>
struct EnumNames;

template <>
struct EnumNames<Precision> {
  static constexpr Named<Precision> list[] = {{Precision::float32, "float"},
                                              {Precision::float64, "double"}};
};

template <>
struct EnumNames<SnowModel> {
  static constexpr Named<SnowModel> list[] = {{SnowModel::cam_clay, "cam_clay"},
                                              {SnowModel::elastic, "elastic"}};
};

template <>
struct EnumNames<Transfer> {
  static constexpr Named<Transfer> list[] = {{Transfer::flip, "flip"}, {Transfer::apic, "apic"}};
};

template <>
struct EnumNames<Basis> {
  static constexpr Named<Basis> list[] = {{Basis::quadratic, "quadratic"}, {Basis::cubic, "cubic"}};
};

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

template <>
struct EnumNames<GrainSides> {
  static constexpr Named<GrainSides> list[] = {{GrainSides::walls, "walls"},
                                               {GrainSides::periodic, "periodic"}};
};

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

template <>
struct EnumNames<LoadingKind> {
  static constexpr Named<LoadingKind> list[] = {{LoadingKind::compress, "compress"},
                                                {LoadingKind::unload, "unload"},
                                                {LoadingKind::stretch, "stretch"},
                                                {LoadingKind::shear, "shear"},
                                                {LoadingKind::isotropic, "isotropic"},
                                                {LoadingKind::penetrate, "penetrate"},
                                                {LoadingKind::hold, "hold"}};
};

template <>
struct EnumNames<Condition> {
  static constexpr Named<Condition> list[] = {
      {Condition::sticky, "sticky"}, {Condition::slip, "slip"}, {Condition::separate, "separate"}};
};

template <>
struct EnumNames<SeedPattern> {
  static constexpr Named<SeedPattern> list[] = {{SeedPattern::regular, "regular"},
                                                {SeedPattern::jittered, "jittered"},
                                                {SeedPattern::poisson, "poisson"}};
};

template <>
struct EnumNames<MisplacedSnow> {
  static constexpr Named<MisplacedSnow> list[] = {{MisplacedSnow::refuse, "refuse"},
                                                  {MisplacedSnow::allow, "allow"}};
};

template <>
struct EnumNames<Between> {
  static constexpr Named<Between> list[] = {{Between::carry, "carry"}, {Between::reseed, "reseed"}};
};

/// The name of a value; null for a value outside the enumeration.
template <class E>
constexpr const char* name_of(E value) {
  for (const auto& named : EnumNames<E>::list) {
    if (named.value == value) return named.name;
  }
  return nullptr;
}

}  // namespace snowshed
