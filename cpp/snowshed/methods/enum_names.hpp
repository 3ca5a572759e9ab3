// The names of the values of enumerations, in JSON and in messages.
#pragma once

#include "snowshed/material/snow.hpp"
#include "snowshed/methods/contact_law.hpp"
#include "snowshed/methods/scene_parts.hpp"

namespace snowshed::methods {

template <class E>
struct Named {
  E value;
  const char* name;
};

/// `EnumNames<E>::list` holds every value of E with its name.
template <class E>
struct EnumNames;

template <>
struct EnumNames<material::SnowModel> {
  static constexpr Named<material::SnowModel> list[] = {{material::SnowModel::cam_clay, "cam_clay"},
                                                        {material::SnowModel::elastic, "elastic"}};
};

template <>
struct EnumNames<Condition> {
  static constexpr Named<Condition> list[] = {
      {Condition::sticky, "sticky"}, {Condition::slip, "slip"}, {Condition::separate, "separate"}};
};

template <>
struct EnumNames<sampling::SeedPattern> {
  static constexpr Named<sampling::SeedPattern> list[] = {
      {sampling::SeedPattern::regular, "regular"},
      {sampling::SeedPattern::jittered, "jittered"},
      {sampling::SeedPattern::poisson, "poisson"}};
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

}  // namespace snowshed::methods
