// The method that a scene has chosen, with its settings.
#pragma once

#include <memory>
#include <stdexcept>
#include <type_traits>

#include "snowshed/methods/registry.hpp"

namespace snowshed::methods {

class MethodChoice {
 public:
  /// The default method with its default settings.
  MethodChoice();
  explicit MethodChoice(const MethodDescriptor& descriptor) : descriptor_(descriptor.clone()) {}
  /// The method with these settings.
  template <class Settings, class = std::enable_if_t<std::is_aggregate_v<Settings>>>
  MethodChoice(const Settings& settings) : MethodChoice(method_with<Settings>()) {
    as<Settings>() = settings;
  }
  MethodChoice(const MethodChoice& other) : MethodChoice(*other.descriptor_) {}
  MethodChoice(MethodChoice&&) = default;
  MethodChoice& operator=(MethodChoice other) {
    descriptor_ = std::move(other.descriptor_);
    return *this;
  }

  MethodDescriptor* operator->() { return descriptor_.get(); }
  const MethodDescriptor* operator->() const { return descriptor_.get(); }
  bool takes(Part part) const { return descriptor_->info().takes.has(part); }
  bool is_default() const;
  /// The same method with its default settings.
  MethodChoice usual() const;

  /// Whether the method's settings have this type.
  template <class Settings>
  bool is() const {
    return holder<Settings>(*descriptor_) != nullptr;
  }
  /// The settings, which must be of this type.
  template <class Settings>
  Settings& as() {
    if (auto* own = dynamic_cast<WithSettings<Settings>*>(descriptor_.get()))
      return own->settings();
    throw std::logic_error("settings of another method");
  }
  template <class Settings>
  const Settings& as() const {
    if (const auto* own = holder<Settings>(*descriptor_)) return own->settings();
    throw std::logic_error("settings of another method");
  }

 private:
  template <class Settings>
  static const WithSettings<Settings>* holder(const MethodDescriptor& method) {
    return dynamic_cast<const WithSettings<Settings>*>(&method);
  }
  template <class Settings>
  static const MethodDescriptor& method_with() {
    for (const MethodDescriptor* method : all_methods())
      if (holder<Settings>(*method)) return *method;
    throw std::logic_error("settings of no method");
  }

  std::unique_ptr<MethodDescriptor> descriptor_;
};

}  // namespace snowshed::methods
