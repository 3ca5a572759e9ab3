// The names of the values of enumerations, in JSON and in messages.
#pragma once

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/contact_law.hpp"
#include "snowshed/methods/scene_parts.hpp"

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
struct EnumNames<SnowModel> {
  static constexpr Named<SnowModel> list[] = {{SnowModel::cam_clay, "cam_clay"},
                                              {SnowModel::elastic, "elastic"}};
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
