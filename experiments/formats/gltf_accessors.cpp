#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "experiments/formats/gltf_model.h"

namespace geoprior::gltf {
namespace {

std::size_t bytes_of(Component component) {
  switch (component) {
    case Component::i8:
    case Component::u8:
      return 1;
    case Component::i16:
    case Component::u16:
      return 2;
    case Component::u32:
    case Component::f32:
      return 4;
  }
  return 4;
}

template <class T>
T load(const std::byte* at) {
  T x;
  std::memcpy(&x, at, sizeof(T));
  return x;
}

double load_component(const std::byte* at, Component component, bool normalized) {
  switch (component) {
    case Component::i8: {
      const double x = load<std::int8_t>(at);
      return normalized ? std::max(x / 127.0, -1.0) : x;
    }
    case Component::u8:
      return load<std::uint8_t>(at) / (normalized ? 255.0 : 1.0);
    case Component::i16: {
      const double x = load<std::int16_t>(at);
      return normalized ? std::max(x / 32767.0, -1.0) : x;
    }
    case Component::u16:
      return load<std::uint16_t>(at) / (normalized ? 65535.0 : 1.0);
    case Component::u32:
      return load<std::uint32_t>(at);
    case Component::f32:
      return static_cast<double>(load<float>(at));
  }
  return 0;
}

/// Columns of matrices of one- and two-byte components start at multiples of four bytes.
std::vector<std::size_t> component_offsets(const Accessor& accessor) {
  const std::size_t size = bytes_of(accessor.component);
  const auto columns = static_cast<std::size_t>(accessor.columns);
  const std::size_t rows = !accessor.is_matrix ? columns : columns == 4 ? 2 : columns == 9 ? 3 : 4;
  const std::size_t column_bytes = accessor.is_matrix ? (rows * size + 3) / 4 * 4 : rows * size;
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < columns; ++i)
    offsets.push_back(i / rows * column_bytes + i % rows * size);
  return offsets;
}

/// Start of `count` elements of `element` bytes, `stride` apart, after a check that they lie in the
/// view.
const std::byte* range(const Model& model, std::size_t view_index, std::size_t offset,
                       std::size_t count, std::size_t stride, std::size_t element,
                       const std::string& where) {
  const BufferView& view = model.views[view_index];
  const bool fits = offset <= view.length && element <= view.length - offset &&
                    count - 1 <= (view.length - offset - element) / stride;
  if (!fits) {
    throw Error(std::to_string(count) + " elements of " + std::to_string(element) +
                    " bytes from byte " + std::to_string(offset) + " reach out of buffer view " +
                    std::to_string(view_index),
                where, "at most its " + std::to_string(view.length) + " bytes");
  }
  return model.buffers[view.buffer].bytes.data() + view.offset + offset;
}

void apply_sparse(const Model& model, const Accessor& accessor, const std::string& where,
                  const std::vector<std::size_t>& offsets, std::size_t element,
                  Eigen::MatrixXd& values) {
  const SparseValues& sparse = *accessor.sparse;
  const std::size_t index_bytes = bytes_of(sparse.index_type);
  const std::byte* indices = range(model, sparse.index_view, sparse.index_offset, sparse.count,
                                   index_bytes, index_bytes, where + "/sparse/indices");
  const std::byte* data = range(model, sparse.value_view, sparse.value_offset, sparse.count,
                                element, element, where + "/sparse/values");
  for (std::size_t k = 0; k < sparse.count; ++k) {
    const double index = load_component(indices + k * index_bytes, sparse.index_type, false);
    if (index >= static_cast<double>(accessor.count)) {
      throw Error(
          "sparse index " + std::to_string(static_cast<std::uint64_t>(index)) + " is out of range",
          where, "0 to " + std::to_string(accessor.count - 1));
    }
    for (std::size_t c = 0; c < offsets.size(); ++c) {
      values(static_cast<Eigen::Index>(index), static_cast<Eigen::Index>(c)) =
          load_component(data + k * element + offsets[c], accessor.component, accessor.normalized);
    }
  }
}

}  // namespace

Eigen::MatrixXd decode(const Model& model, std::size_t accessor_index) {
  // An accessor without data costs its file nothing: bounded, so that a few bytes cannot ask for
  // all memory.
  constexpr std::size_t kMaxWithoutData = std::size_t{1} << 20;
  const Accessor& accessor = model.accessors[accessor_index];
  const std::string where = place(model, "/accessors/" + std::to_string(accessor_index));
  const std::vector<std::size_t> offsets = component_offsets(accessor);
  const std::size_t element = offsets.back() + bytes_of(accessor.component);
  const std::byte* data = nullptr;
  std::size_t stride = element;
  if (accessor.view) {
    stride = model.views[*accessor.view].stride.value_or(element);
    if (stride < element) {
      throw Error("elements of " + std::to_string(element) + " bytes overlap at a stride of " +
                      std::to_string(stride),
                  where);
    }
    data = range(model, *accessor.view, accessor.offset, accessor.count, stride, element, where);
  } else if (accessor.count > kMaxWithoutData) {
    throw Error(std::to_string(accessor.count) + " elements without a buffer view", where,
                "at most " + std::to_string(kMaxWithoutData));
  }
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(accessor.count), accessor.columns);
  if (data != nullptr) {
    for (std::size_t i = 0; i < accessor.count; ++i) {
      for (std::size_t c = 0; c < offsets.size(); ++c) {
        values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
            load_component(data + i * stride + offsets[c], accessor.component, accessor.normalized);
      }
    }
  }
  if (accessor.sparse) apply_sparse(model, accessor, where, offsets, element, values);
  return values;
}

std::vector<std::uint32_t> decode_indices(const Model& model, std::size_t accessor_index) {
  const Accessor& accessor = model.accessors[accessor_index];
  const bool is_unsigned = accessor.component == Component::u8 ||
                           accessor.component == Component::u16 ||
                           accessor.component == Component::u32;
  if (!is_unsigned || accessor.columns != 1 || accessor.normalized) {
    throw Error("indices are not unsigned integers",
                place(model, "/accessors/" + std::to_string(accessor_index)),
                "SCALAR of component type 5121, 5123, 5125");
  }
  const Eigen::MatrixXd values = decode(model, accessor_index);
  std::vector<std::uint32_t> indices(static_cast<std::size_t>(values.rows()));
  for (std::size_t i = 0; i < indices.size(); ++i)
    indices[i] = static_cast<std::uint32_t>(values(static_cast<Eigen::Index>(i), 0));
  return indices;
}

}  // namespace geoprior::gltf
