// The method that a scene has chosen, with its settings.
#pragma once

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <typeinfo>

#include "snowshed/methods/descriptor.hpp"

namespace snowshed {

class MethodChoice {
 public:
  /// The default method with its default settings.
  MethodChoice();
  explicit MethodChoice(const MethodDescriptor& descriptor) : descriptor_(descriptor.clone()) {}
  /// The method with these settings.
  template <class Settings, class = std::enable_if_t<std::is_aggregate_v<Settings>>>
  MethodChoice(const Settings& settings) : MethodChoice(method_with(typeid(Settings))) {
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
  bool takes(Part part) const { return descriptor_->facts().takes.has(part); }
  bool is_default() const;

  /// Whether these are the settings of the method.
  template <class Settings>
  bool is() const {
    return descriptor_->settings(typeid(Settings)) != nullptr;
  }
  /// The settings, which must be of this type.
  template <class Settings>
  Settings& as() {
    if (!is<Settings>()) throw std::logic_error("settings of another method");
    return *static_cast<Settings*>(descriptor_->settings(typeid(Settings)));
  }
  template <class Settings>
  const Settings& as() const {
    return const_cast<MethodChoice*>(this)->as<Settings>();
  }

 private:
  static const MethodDescriptor& method_with(const std::type_info& settings);

  std::unique_ptr<MethodDescriptor> descriptor_;
};

}  // namespace snowshed
