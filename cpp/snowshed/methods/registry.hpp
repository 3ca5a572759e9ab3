// The methods of the program.
#pragma once

#include <string>
#include <vector>

#include "snowshed/methods/descriptor.hpp"

namespace snowshed::methods {

/// All methods, with their default settings. The first is the default of scenes.
const std::vector<const MethodDescriptor*>& all_methods();

/// The error at a part of a scene that a method does not take, with the methods that do.
std::string takes_no_part(const MethodInfo& method, Part part);

std::vector<std::string> method_names();

/// Adds a method of a program that links the library, as long as this object exists. No method may
/// be added or removed while another thread looks up methods.
class RegisteredMethod {
 public:
  explicit RegisteredMethod(const MethodDescriptor&);
  RegisteredMethod(const RegisteredMethod&) = delete;
  RegisteredMethod& operator=(const RegisteredMethod&) = delete;
  ~RegisteredMethod();
};

}  // namespace snowshed::methods
