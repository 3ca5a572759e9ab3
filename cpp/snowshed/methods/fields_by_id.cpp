#include "snowshed/methods/fields_by_id.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace snowshed::methods {

bool has_field(const Method& method, const std::string& name) {
  const std::vector<particles::FieldInfo> fields = method.fields();
  return std::any_of(fields.begin(), fields.end(),
                     [&](const particles::FieldInfo& field) { return field.name == name; });
}

std::vector<double> values_by_id(const Method& method, const std::string& name) {
  const particles::FieldView view = method.field(name);
  const auto components = std::size_t(view.info.components);
  std::vector<double> values;
  values.reserve(view.count * components);
  particles::with_field_type(view.info.type, [&](auto zero) {
    using Value = decltype(zero);
    for (const std::uint32_t index : method.order_by_id()) {
      const Value* first = view.at<Value>(index);
      for (std::size_t c = 0; c < components; ++c) values.push_back(double(first[c]));
    }
  });
  return values;
}

}  // namespace snowshed::methods
