#include "testbed/formats/hdf5/file.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/hdf5/handle.h"

namespace geoprior {

namespace h5 {

namespace {

herr_t collect_message(unsigned depth, const H5E_error2_t* entry, void* client) {
  auto& text = *static_cast<std::string*>(client);
  // The outermost entries repeat what we were doing; the innermost names the cause.
  if (entry->desc != nullptr && *entry->desc != '\0') {
    if (depth > 0) text += " <- ";
    text += entry->desc;
  }
  return 0;
}

/// HDF5 tells addresses of its memory, which say nothing to a user.
std::string without_addresses(std::string text) {
  constexpr std::string_view kPrefix = "0x", kHex = "0123456789abcdefABCDEF";
  for (std::size_t at = 0; (at = text.find(kPrefix, at)) != std::string::npos;) {
    const std::size_t end = text.find_first_not_of(kHex, at + kPrefix.size());
    text.replace(at, std::min(end, text.size()) - at, "…");
  }
  return text;
}

}  // namespace

void fail(const std::string& what, const std::string& where) {
  std::string stack;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect_message, &stack);
  H5Eclear2(H5E_DEFAULT);
  throw Error(what + (stack.empty() ? "" : ": " + without_addresses(stack)), where);
}

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle text_type(std::size_t size, const std::string& where) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text type", where);
  check(H5Tset_size(type, size), "text type", where);
  check(H5Tset_cset(type, H5T_CSET_UTF8), "text type", where);
  check(H5Tset_strpad(type, size == H5T_VARIABLE ? H5T_STR_NULLTERM : H5T_STR_NULLPAD), "text type",
        where);
  return type;
}

Handle space_of(const std::vector<std::size_t>& extents, const std::string& where) {
  if (extents.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, "data space", where};
  const std::vector<hsize_t> sizes(extents.begin(), extents.end());
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose,
          "data space", where};
}

std::vector<std::size_t> extents_of(hid_t space, const std::string& where) {
  const int rank = check(H5Sget_simple_extent_ndims(space), "data space", where);
  std::vector<hsize_t> sizes(rank);
  check(H5Sget_simple_extent_dims(space, sizes.data(), nullptr), "data space", where);
  return {sizes.begin(), sizes.end()};
}

std::string encoded(std::string_view name) {
  if (name == ".") return "%2E";
  std::string out;
  for (const char c : name) {
    if (c == '/') {
      out += "%2F";
    } else if (c == '%') {
      out += "%25";
    } else {
      out += c;
    }
  }
  return out;
}

std::string decoded(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const std::string_view code = name.substr(i, 3);
    if (code == "%2F" || code == "%25" || code == "%2E") {
      out += code == "%2F" ? '/' : code == "%25" ? '%' : '.';
      i += 2;
    } else {
      out += name[i];
    }
  }
  return out;
}

}  // namespace h5

using h5::check;
using h5::Handle;

namespace {

std::vector<std::byte> image_of(hid_t file, const std::string& name) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL), "cannot be written", name);
  const ssize_t size = check(H5Fget_file_image(file, nullptr, 0), "cannot be written", name);
  std::vector<std::byte> image(size);
  check(H5Fget_file_image(file, image.data(), image.size()), "cannot be written", name);
  return image;
}

}  // namespace

H5Group::H5Group(H5Group&& other) noexcept
    : id_(std::exchange(other.id_, -1)), place_(std::move(other.place_)) {}

H5Group& H5Group::operator=(H5Group&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(place_, other.place_);
  return *this;
}

H5Group::~H5Group() {
  if (id_ >= 0) H5Gclose(id_);
}

std::string H5Group::at(std::string_view name) const {
  return place_ + (place_.ends_with('/') ? "" : "/") + std::string(name);
}

H5Group H5Group::create_group(std::string_view name) {
  const std::string where = at(name);
  Handle id(H5Gcreate2(id_, h5::encoded(name).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Gclose, "group cannot be made", where);
  return {id.give_up(), where};
}

void H5Group::write_array(std::string_view name, const H5Array& array) {
  const std::string where = at(name);
  std::size_t count = 1;
  for (const std::size_t n : array.extents) count *= n;
  if (count != array.values.size()) throw Error("extents do not match the values", where);
  const Handle space = h5::space_of(array.extents, where);
  const Handle data(H5Dcreate2(id_, h5::encoded(name).c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                               H5P_DEFAULT, H5P_DEFAULT),
                    H5Dclose, "data set cannot be made", where);
  for (const auto& [key, text] : array.attributes) h5::write_text(data, key, text, where);
  if (count == 0) return;
  check(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()),
        "data set cannot be written", where);
}

H5File H5File::create() {
  h5::silence();
  const std::string name = "new HDF5 file";
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot be made", name);
  constexpr std::size_t kGrowth = 1 << 20;
  check(H5Pset_fapl_core(access, kGrowth, false), "cannot be made", name);
  // HDF5 refuses a name that is open already, although nothing goes to the disk.
  static std::atomic<unsigned> count{0};
  const std::string unique = "in-memory-" + std::to_string(count++) + ".h5";
  Handle id(H5Fcreate(unique.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
            "cannot be made", name);
  return {id.give_up(), name};
}

H5File::H5File(H5File&& other) noexcept
    : id_(std::exchange(other.id_, -1)), name_(std::move(other.name_)) {}

H5File& H5File::operator=(H5File&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(name_, other.name_);
  return *this;
}

H5File::~H5File() {
  if (id_ >= 0) H5Fclose(id_);
}

H5Group H5File::root() const {
  const std::string where = name_ + ": /";
  Handle id(H5Gopen2(id_, "/", H5P_DEFAULT), H5Gclose, "cannot be read", where);
  return {id.give_up(), where};
}

std::vector<std::byte> H5File::bytes() const { return image_of(id_, name_); }

void H5File::save(const std::filesystem::path& file) const {
  write_file_atomically(file, std::span<const std::byte>(image_of(id_, file.string())));
}

namespace {

void write_number(hid_t owner, std::string_view name, hid_t file_type, hid_t memory_type,
                  const void* value, const std::string& where) {
  const Handle space = h5::space_of({}, where);
  const Handle attribute(
      H5Acreate2(owner, std::string(name).c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, "attribute cannot be made", where);
  check(H5Awrite(attribute, memory_type, value), "attribute cannot be written", where);
}

void write_texts(hid_t owner, std::string_view name, const std::vector<std::size_t>& extents,
                 const std::vector<const char*>& texts, const std::string& where) {
  const Handle type = h5::text_type(H5T_VARIABLE, where);
  const Handle space = h5::space_of(extents, where);
  const Handle attribute(
      H5Acreate2(owner, std::string(name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      "attribute cannot be made", where);
  if (texts.empty()) return;
  check(H5Awrite(attribute, type, texts.data()), "attribute cannot be written", where);
}

}  // namespace

void H5Group::write_attribute(std::string_view name, const std::string& text) {
  write_texts(id_, name, {}, {text.c_str()}, at(name));
}

void H5Group::write_attribute(std::string_view name, const std::vector<std::string>& texts) {
  h5::write_text_list(id_, name, texts, at(name));
}

void H5Group::write_attribute(std::string_view name, double value) {
  write_number(id_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value, at(name));
}

void H5Group::write_attribute(std::string_view name, std::int64_t value) {
  write_number(id_, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value, at(name));
}

void H5Group::write_attribute(std::string_view name, std::uint64_t value) {
  write_number(id_, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &value, at(name));
}

namespace h5 {

void write_text(hid_t owner, const std::string& name, const std::string& text,
                const std::string& where) {
  write_texts(owner, name, {}, {text.c_str()}, where + "@" + name);
}

void write_text_list(hid_t owner, std::string_view name, const std::vector<std::string>& texts,
                     const std::string& where) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  write_texts(owner, name, {texts.size()}, pointers, where);
}

}  // namespace h5

namespace {

constexpr unsigned kZlibLevel = 4;
struct NumberType {
  hid_t file, memory;
};

NumberType type_of(float) { return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT}; }
NumberType type_of(double) { return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE}; }
NumberType type_of(std::int32_t) { return {H5T_STD_I32LE, H5T_NATIVE_INT32}; }
NumberType type_of(std::int64_t) { return {H5T_STD_I64LE, H5T_NATIVE_INT64}; }

std::size_t product(const std::vector<std::size_t>& extents) {
  std::size_t count = 1;
  for (const std::size_t n : extents) count *= n;
  return count;
}

}  // namespace

template <class T>
void H5Group::write_block(std::string_view name, const std::vector<std::size_t>& extents,
                          std::span<const T> values) {
  const std::string where = at(name);
  if (product(extents) != values.size()) throw Error("extents do not match the values", where);
  const Handle space = h5::space_of(extents, where);
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "layout", where);
  check(H5Pset_obj_track_times(layout, false), "layout", where);
  if (!values.empty()) {  // HDF5 knows no chunks without entries
    std::vector<hsize_t> chunk(extents.begin(), extents.end());
    if (chunk.size() > 2) chunk[0] = 1;
    check(H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data()), "layout", where);
    check(H5Pset_shuffle(layout), "layout", where);
    check(H5Pset_deflate(layout, kZlibLevel), "layout", where);
  }
  const NumberType type = type_of(T());
  const Handle data(H5Dcreate2(id_, h5::encoded(name).c_str(), type.file, space, H5P_DEFAULT,
                               layout, H5P_DEFAULT),
                    H5Dclose, "data set cannot be made", where);
  if (values.empty()) return;
  check(H5Dwrite(data, type.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "data set cannot be written", where);
}

template void H5Group::write_block(std::string_view, const std::vector<std::size_t>&,
                                   std::span<const float>);
template void H5Group::write_block(std::string_view, const std::vector<std::size_t>&,
                                   std::span<const double>);
template void H5Group::write_block(std::string_view, const std::vector<std::size_t>&,
                                   std::span<const std::int32_t>);
template void H5Group::write_block(std::string_view, const std::vector<std::size_t>&,
                                   std::span<const std::int64_t>);

namespace {

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

using Vector3 = std::array<double, 3>;

std::size_t length(const H5Column& column) {
  return std::visit([](const auto& values) { return values.size(); }, column.values);
}

Handle number_type(hid_t type, const std::string& where) {
  return {H5Tcopy(type), H5Tclose, "table type", where};
}

Handle vector3_type(const std::string& where) {
  const hsize_t three = 3;
  return {H5Tarray_create2(H5T_IEEE_F64LE, 1, &three), H5Tclose, "table type", where};
}

/// Type of a column in the file. Memory has the same: the format's machines are little endian, as
/// are all that this project builds on (x86-64).
Handle column_type(const H5Column& column, const std::string& where) {
  return std::visit(
      Overloaded{
          [&](const std::vector<double>&) { return number_type(H5T_IEEE_F64LE, where); },
          [&](const std::vector<std::int64_t>&) { return number_type(H5T_STD_I64LE, where); },
          [&](const std::vector<Vector3>&) { return vector3_type(where); },
          [&](const std::vector<std::string>& texts) {
            std::size_t size = 1;
            for (const std::string& text : texts) size = std::max(size, text.size());
            return h5::text_type(size, where);
          },
      },
      column.values);
}

void pack(const H5Column& column, std::size_t offset, std::size_t stride,
          std::vector<char>& buffer) {
  std::visit(Overloaded{
                 [&](const std::vector<std::string>& texts) {
                   for (std::size_t i = 0; i < texts.size(); ++i) {
                     std::memcpy(buffer.data() + i * stride + offset, texts[i].data(),
                                 texts[i].size());
                   }
                 },
                 [&](const auto& values) {
                   for (std::size_t i = 0; i < values.size(); ++i) {
                     std::memcpy(buffer.data() + i * stride + offset, &values[i], sizeof values[i]);
                   }
                 },
             },
             column.values);
}

}  // namespace

void H5Group::write_table(std::string_view name, const std::vector<H5Column>& columns) {
  const std::string where = at(name);
  const std::size_t count = length(columns.front());
  std::vector<Handle> types;
  std::vector<std::size_t> offsets;
  std::size_t stride = 0;
  for (const H5Column& column : columns) {
    if (length(column) != count) throw Error("columns of unequal length", where);
    types.push_back(column_type(column, where));
    offsets.push_back(stride);
    stride += H5Tget_size(types.back());
  }
  const Handle table(H5Tcreate(H5T_COMPOUND, stride), H5Tclose, "table type", where);
  std::vector<char> buffer(stride * count, '\0');
  for (std::size_t c = 0; c < columns.size(); ++c) {
    check(H5Tinsert(table, columns[c].name.c_str(), offsets[c], types[c]), "table type", where);
    pack(columns[c], offsets[c], stride, buffer);
  }
  const Handle space = h5::space_of({count}, where);
  const Handle data(H5Dcreate2(id_, h5::encoded(name).c_str(), table, space, H5P_DEFAULT,
                               H5P_DEFAULT, H5P_DEFAULT),
                    H5Dclose, "table cannot be made", where);
  if (count == 0) return;
  check(H5Dwrite(data, table, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer.data()),
        "table cannot be written", where);
}

void H5Group::write_matrix(std::string_view name, const std::vector<std::string>& columns,
                           const std::vector<double>& values) {
  constexpr std::size_t kChunkRows = 4096;
  const std::string where = at(name);
  const std::size_t rows = values.size() / columns.size();
  if (rows * columns.size() != values.size()) throw Error("a row is not whole", where);
  const Handle space = h5::space_of({rows, columns.size()}, where);
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "layout", where);
  if (rows > 0) {  // HDF5 knows no chunks without rows
    const std::array<hsize_t, 2> chunk{std::min(rows, kChunkRows), columns.size()};
    check(H5Pset_chunk(layout, 2, chunk.data()), "layout", where);
    check(H5Pset_deflate(layout, 6), "layout", where);
  }
  const Handle data(H5Dcreate2(id_, h5::encoded(name).c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                               layout, H5P_DEFAULT),
                    H5Dclose, "data set cannot be made", where);
  h5::write_text_list(data, "columns", columns, where);
  if (rows == 0) return;
  check(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "data set cannot be written", where);
}

}  // namespace geoprior
