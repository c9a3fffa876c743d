#include <cstdint>

#include "core/error.h"
#include "experiments/formats/hdf5_file.h"
#include "experiments/formats/hdf5_handle.h"

namespace geoprior {

using h5::check;
using h5::Handle;

namespace {

constexpr unsigned kZlibLevel = 4;
/// zlib makes zeros 1032 times smaller at most; what says more is damaged.
constexpr std::size_t kLargestRatio = 1100;

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

/// In floating point, because the product of the extents of a damaged file overflows.
bool can_be_stored(const std::vector<std::size_t>& extents, std::size_t bytes_of_one,
                   std::size_t stored) {
  double bytes = static_cast<double>(bytes_of_one);
  for (const std::size_t n : extents) bytes *= static_cast<double>(n);
  return bytes <= static_cast<double>(stored) * kLargestRatio;
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

template <class T>
H5Block<T> H5Group::read_block(std::string_view name, std::size_t rank) const {
  const std::string where = at(name);
  const Handle data(H5Dopen2(id_, h5::encoded(name).c_str(), H5P_DEFAULT), H5Dclose,
                    "data set is missing", where);
  const Handle space(H5Dget_space(data), H5Sclose, "data set cannot be read", where);
  H5Block<T> block;
  block.extents = h5::extents_of(space, where);
  if (block.extents.size() != rank) {
    throw Error("has " + std::to_string(block.extents.size()) + " extents", where,
                std::to_string(rank));
  }
  if (!can_be_stored(block.extents, sizeof(T), H5Dget_storage_size(data))) {
    throw Error("says to be larger than the file", where);
  }
  block.values.resize(product(block.extents));
  if (block.values.empty()) return block;
  check(H5Dread(data, type_of(T()).memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, block.values.data()),
        "data set cannot be read", where);
  return block;
}

#define GEOPRIOR_BLOCK(T)                                                               \
  template void H5Group::write_block(std::string_view, const std::vector<std::size_t>&, \
                                     std::span<const T>);                               \
  template H5Block<T> H5Group::read_block(std::string_view, std::size_t) const
GEOPRIOR_BLOCK(float);
GEOPRIOR_BLOCK(double);
GEOPRIOR_BLOCK(std::int32_t);
GEOPRIOR_BLOCK(std::int64_t);
#undef GEOPRIOR_BLOCK

}  // namespace geoprior
