#include "field_arrays.hpp"

#include <cstdint>
#include <type_traits>

namespace py = pybind11;

namespace snowshed {
namespace {

std::vector<py::ssize_t> shape_of(const particles::FieldView& view) {
  const auto n = py::ssize_t(view.count);
  switch (view.info.components) {
    case 1:
      return {n};
    case 9:
      return {n, 3, 3};
    default:
      return {n, view.info.components};
  }
}

/// Bytes from one index to the next along each axis; only the first axis may have gaps.
std::vector<py::ssize_t> strides_of(const particles::FieldView& view,
                                    const std::vector<py::ssize_t>& shape,
                                    py::ssize_t element_bytes) {
  std::vector<py::ssize_t> strides(shape.size(), element_bytes);
  for (std::size_t axis = shape.size() - 1; axis-- > 1;)
    strides[axis] = strides[axis + 1] * shape[axis + 1];
  strides[0] = view.stride;
  return strides;
}

/// Returns an object by which Python keeps a view's memory alive.
py::capsule owner_of(const particles::FieldView& view) {
  using Owner = std::shared_ptr<const void>;
  return py::capsule(new Owner(view.elements),
                     [](void* owner) { delete static_cast<Owner*>(owner); });
}

}  // namespace

py::array array_of(const particles::FieldView& view) {
  return particles::with_field_type(view.info.type, [&](auto zero) {
    using Value = decltype(zero);
    const auto shape = shape_of(view);
    py::array array =
        py::array_t<Value>(shape, strides_of(view, shape, sizeof(Value)),
                           static_cast<const Value*>(view.elements.get()), owner_of(view));
    array.attr("flags").attr("writeable") = false;
    return array;
  });
}

py::array array_by_id(const methods::Method& method, const std::string& name) {
  const particles::FieldView view = method.field(name);
  const std::vector<std::uint32_t>& order = method.order_by_id();
  return particles::with_field_type(view.info.type, [&](auto zero) -> py::array {
    using Value = decltype(zero);
    using Copy = std::conditional_t<std::is_floating_point_v<Value>, double, std::int64_t>;
    py::array_t<Copy> copy(shape_of(view));
    Copy* out = copy.mutable_data();
    for (const std::uint32_t index : order) {
      const Value* values = view.at<Value>(index);
      for (int c = 0; c < view.info.components; ++c) *out++ = Copy(values[c]);
    }
    return copy;
  });
}

}  // namespace snowshed
