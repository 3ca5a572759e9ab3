#include "snowshed/gpu/shared_library.hpp"

#include <dlfcn.h>

#include "snowshed/gpu/unavailable.hpp"

namespace snowshed::gpu {
namespace {

std::string reason() {
  const char* text = ::dlerror();
  return text ? text : "the system gives no reason";
}

}  // namespace

SharedLibrary::SharedLibrary(const std::string& name)
    : name_(name), handle_(::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (!handle_) throw Unavailable(reason());
}

void* SharedLibrary::symbol(const char* name) const {
  void* const address = ::dlsym(handle_, name);
  if (!address) throw Unavailable(name_ + " has no function " + name);
  return address;
}

}  // namespace snowshed::gpu
