// Laws of the user that Python passes to the core: a dict of names and of addresses of functions.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>

#include "snowshed/methods/user_laws.hpp"

namespace snowshed {

template <class Function>
Function function_at(const pybind11::handle& address) {
  return reinterpret_cast<Function>(address.cast<std::uintptr_t>());
}

/// The laws of a dict; None and missing keys stand for no law.
inline methods::UserLaws laws_of(const pybind11::object& given) {
  methods::UserLaws laws;
  if (given.is_none()) return laws;
  const auto dict = given.cast<pybind11::dict>();
  laws.name = dict["name"].cast<std::string>();
  if (dict.contains("digest")) laws.digest = dict["digest"].cast<std::string>();
  if (dict.contains("material")) laws.material = function_at<void*>(dict["material"]);
  if (dict.contains("constitutive")) {
    laws.constitutive = function_at<void*>(dict["constitutive"]);
    laws.own_numbers = dict["own_numbers"].cast<int>();
  }
  if (dict.contains("body_force"))
    laws.body_force = function_at<methods::BodyForce>(dict["body_force"]);
  if (dict.contains("friction"))
    for (const auto& [name, address] : dict["friction"].cast<pybind11::dict>())
      laws.friction[name.cast<std::string>()] = function_at<methods::FrictionLaw>(address);
  if (dict.contains("motion"))
    for (const auto& [name, address] : dict["motion"].cast<pybind11::dict>())
      laws.motion[name.cast<std::string>()] = function_at<methods::MotionLaw>(address);
  return laws;
}

}  // namespace snowshed
