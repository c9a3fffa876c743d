#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "experiments/formats/hdf5_file.h"
#include "experiments/formats/hdf5_handle.h"

namespace geoprior {

using h5::check;
using h5::Handle;

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

void unpack(const std::vector<char>& buffer, std::size_t stride, std::size_t count,
            H5Column& column) {
  std::visit(Overloaded{
                 [&](std::vector<std::string>& texts) {
                   for (std::size_t i = 0; i < count; ++i) {
                     const char* begin = buffer.data() + i * stride;
                     texts.emplace_back(begin, strnlen(begin, stride));
                   }
                 },
                 [&](auto& values) {
                   values.resize(count);
                   for (std::size_t i = 0; i < count; ++i) {
                     std::memcpy(&values[i], buffer.data() + i * stride, stride);
                   }
                 },
             },
             column.values);
}

/// Type of a member of the table in the file, checked against what the caller wants.
Handle stored_type(hid_t table, const H5Column& wanted, const std::string& where) {
  const int index = H5Tget_member_index(table, wanted.name.c_str());
  if (index < 0) h5::fail("table has no column '" + wanted.name + "'", where);
  Handle type(H5Tget_member_type(table, static_cast<unsigned>(index)), H5Tclose, "table column",
              where);
  const H5T_class_t expected =
      std::visit(Overloaded{
                     [](const std::vector<double>&) { return H5T_FLOAT; },
                     [](const std::vector<std::int64_t>&) { return H5T_INTEGER; },
                     [](const std::vector<Vector3>&) { return H5T_ARRAY; },
                     [](const std::vector<std::string>&) { return H5T_STRING; },
                 },
                 wanted.values);
  if (H5Tget_class(type) != expected || H5Tis_variable_str(type) > 0) {
    h5::fail("column '" + wanted.name + "' has another type", where);
  }
  if (expected == H5T_STRING) return type;
  return column_type(wanted, where);
}

void read_column(hid_t data, hid_t table, std::size_t count, H5Column& column,
                 const std::string& where) {
  const Handle type = stored_type(table, column, where);
  const std::size_t stride = H5Tget_size(type);
  const Handle memory(H5Tcreate(H5T_COMPOUND, stride), H5Tclose, "table type", where);
  check(H5Tinsert(memory, column.name.c_str(), 0, type), "table type", where);
  std::vector<char> buffer(stride * count);
  if (count > 0) {
    check(H5Dread(data, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer.data()),
          "table cannot be read", where);
  }
  unpack(buffer, stride, count, column);
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

void H5Group::read_table(std::string_view name, std::vector<H5Column>& columns) const {
  const std::string where = at(name);
  const Handle data(H5Dopen2(id_, h5::encoded(name).c_str(), H5P_DEFAULT), H5Dclose,
                    "table is missing", where);
  const Handle table(H5Dget_type(data), H5Tclose, "table cannot be read", where);
  if (H5Tget_class(table) != H5T_COMPOUND) h5::fail("is no table", where);
  const Handle space(H5Dget_space(data), H5Sclose, "table cannot be read", where);
  const std::vector<std::size_t> extents = h5::extents_of(space, where);
  if (extents.size() != 1) h5::fail("is no table", where);
  for (H5Column& column : columns) read_column(data, table, extents[0], column, where);
}

}  // namespace geoprior
