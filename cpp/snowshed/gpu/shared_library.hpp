// A shared library that is opened while the program runs.
#pragma once

#include <string>

namespace snowshed::gpu {

/// A library that stays open until the process ends, because drivers do not survive being closed.
class SharedLibrary {
 public:
  /// Throws Unavailable with the system's reason if the library cannot be opened. A name without a
  /// slash is looked for where the system's loader looks.
  explicit SharedLibrary(const std::string& name);

  const std::string& name() const { return name_; }

  /// Sets a pointer to the function of this name. Throws Unavailable if there is none.
  template <class Function>
  void find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  std::string name_;
  void* handle_;
};

}  // namespace snowshed::gpu
