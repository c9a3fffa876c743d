// The one place where HDF5 reads a file: in a child process, everything at once.

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <set>

#include "core/error.h"
#include "testbed/formats/hdf5/content.h"
#include "testbed/formats/hdf5/handle.h"
#include "testbed/formats/isolated_read.h"

namespace geoprior {

using h5::check;
using h5::Handle;

namespace {

/// Groups inside groups; run.h5 has six.
constexpr int kMostDepth = 16;
/// zlib makes zeros 1032 times smaller at most; what says more is damaged.
constexpr double kLargestRatio = 1100;
/// What a file may hold when it is read (bytes).
constexpr double kMostBytes = 16e9;

constexpr const char* kOwn = "what this program writes";

[[noreturn]] void foreign(const std::string& what, const std::string& where) {
  throw Error(what, where, kOwn);
}

/// Collects names. Exceptions must not cross the library: what is no link of its own file throws
/// after the iteration, and memory that runs out ends it.
struct Links {
  std::vector<std::string> names;
  std::string foreign;
};

herr_t collect_own_link(hid_t, const char* name, const H5L_info_t* info, void* client) {
  auto& links = *static_cast<Links*>(client);
  try {
    if (info->type != H5L_TYPE_HARD && links.foreign.empty()) links.foreign = name;
    links.names.emplace_back(name);
  } catch (const std::bad_alloc&) {
    return -1;
  }
  return 0;
}

herr_t collect_attribute_name(hid_t, const char* name, const H5A_info_t*, void* client) {
  try {
    static_cast<std::vector<std::string>*>(client)->emplace_back(name);
  } catch (const std::bad_alloc&) {
    return -1;
  }
  return 0;
}

class Reader {
 public:
  Reader(const std::filesystem::path& file)
      : name_(file.string()), file_bytes_(static_cast<double>(std::filesystem::file_size(file))) {}

  H5Content read() {
    h5::silence();
    const Handle file(H5Fopen(name_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                      "is no HDF5 file, or is damaged", name_);
    const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose, "cannot be read", name_);
    return group(root, name_ + ": /", 0);
  }

 private:
  H5Content group(hid_t id, const std::string& where, int depth) {
    if (depth > kMostDepth)
      foreign("has groups more than " + std::to_string(kMostDepth) + " deep", where);
    H5Content content;
    content.attributes = attributes(id, where);
    Links links;
    hsize_t next = 0;
    check(H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, &next, collect_own_link, &links),
          "group cannot be listed", where);
    const std::string prefix = where + (where.ends_with('/') ? "" : "/");
    if (!links.foreign.empty()) foreign("is a link to another place", prefix + links.foreign);
    for (const std::string& link : links.names) {
      const std::string name = h5::decoded(link), place = prefix + name;
      const Handle object(H5Oopen(id, link.c_str(), H5P_DEFAULT), H5Oclose, "cannot be read",
                          place);
      H5O_info_t info{};
      check(H5Oget_info(object, &info), "cannot be read", place);
      if (info.rc != 1) foreign("has several names", place);
      if (info.type == H5O_TYPE_GROUP) {
        content.groups[name] = group(object, place, depth + 1);
      } else if (info.type == H5O_TYPE_DATASET) {
        content.data[name] = data(object, place);
      } else {
        foreign("is neither group nor data set", place);
      }
    }
    return content;
  }

  std::map<std::string, H5Attribute> attributes(hid_t owner, const std::string& where) {
    std::vector<std::string> names;
    hsize_t next = 0;
    check(H5Aiterate2(owner, H5_INDEX_NAME, H5_ITER_INC, &next, collect_attribute_name, &names),
          "attributes cannot be listed", where);
    std::map<std::string, H5Attribute> out;
    for (const std::string& name : names) out[name] = attribute(owner, name, where + "@" + name);
    return out;
  }

  H5Attribute attribute(hid_t owner, const std::string& name, const std::string& where) {
    const Handle id(H5Aopen(owner, name.c_str(), H5P_DEFAULT), H5Aclose, "attribute cannot be read",
                    where);
    const Handle type(H5Aget_type(id), H5Tclose, "attribute cannot be read", where);
    const Handle space(H5Aget_space(id), H5Sclose, "attribute cannot be read", where);
    const std::vector<std::size_t> extents = h5::extents_of(space, where);
    const H5T_class_t kind = H5Tget_class(type);
    if (kind == H5T_STRING && H5Tis_variable_str(type) > 0) return texts(id, space, extents, where);
    if (!extents.empty()) foreign("attribute is no single number", where);
    if (kind == H5T_FLOAT) return attribute_number<double>(id, H5T_NATIVE_DOUBLE, where);
    if (kind != H5T_INTEGER || H5Tget_size(type) != 8) {
      foreign("attribute is neither text nor a number of 64 bits", where);
    }
    if (H5Tget_sign(type) == H5T_SGN_2) {
      return attribute_number<std::int64_t>(id, H5T_NATIVE_INT64, where);
    }
    return attribute_number<std::uint64_t>(id, H5T_NATIVE_UINT64, where);
  }

  template <class T>
  static T attribute_number(hid_t id, hid_t type, const std::string& where) {
    T value{};
    check(H5Aread(id, type, &value), "attribute cannot be read", where);
    return value;
  }

  std::vector<std::string> texts(hid_t id, hid_t space, const std::vector<std::size_t>& extents,
                                 const std::string& where) {
    const std::size_t count = counted(extents, sizeof(hvl_t), file_bytes_, where);
    if (count == 0) return {};
    std::vector<char*> pointers(count, nullptr);
    const Handle type = h5::text_type(H5T_VARIABLE, where);
    check(H5Aread(id, type, pointers.data()), "attribute cannot be read", where);
    std::vector<std::string> out;
    for (const char* text : pointers) out.emplace_back(text == nullptr ? "" : text);
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
    return out;
  }

  /// Product of the extents, which must fit into `stored` bytes of the file when they are packed as
  /// tightly as zlib can. In floating point, because that of a damaged file overflows.
  std::size_t counted(const std::vector<std::size_t>& extents, std::size_t bytes_of_one,
                      double stored, const std::string& where) {
    double count = 1;
    for (const std::size_t n : extents) count *= static_cast<double>(n);
    const double bytes = count * static_cast<double>(bytes_of_one);
    total_ += bytes;
    if (stored > file_bytes_ || bytes > stored * kLargestRatio || total_ > kMostBytes) {
      foreign("says to be larger than what the file can hold", where);
    }
    return static_cast<std::size_t>(count);
  }

  static void require_own_layout(hid_t id, const std::string& where) {
    const Handle made(H5Dget_create_plist(id), H5Pclose, "data set cannot be read", where);
    if (H5Pget_layout(made) == H5D_VIRTUAL || H5Pget_external_count(made) != 0) {
      foreign("has its values in another file", where);
    }
    for (int i = 0; i < check(H5Pget_nfilters(made), "data set cannot be read", where); ++i) {
      unsigned flags = 0;
      std::size_t values = 0;
      const H5Z_filter_t filter = H5Pget_filter2(made, static_cast<unsigned>(i), &flags, &values,
                                                 nullptr, 0, nullptr, nullptr);
      if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE) {
        foreign("is packed by the filter " + std::to_string(filter), where);
      }
    }
  }

  static void require_size(hid_t type, const std::string& where) {
    const std::size_t size = H5Tget_size(type);
    if (size == 4 || size == 8) return;
    foreign("holds numbers of " + std::to_string(size) + " bytes", where);
  }

  H5Data data(hid_t id, const std::string& where) {
    require_own_layout(id, where);
    const Handle type(H5Dget_type(id), H5Tclose, "data set cannot be read", where);
    const Handle space(H5Dget_space(id), H5Sclose, "data set cannot be read", where);
    H5Data out;
    out.extents = h5::extents_of(space, where);
    out.attributes = attributes(id, where);
    const std::size_t count = counted(out.extents, H5Tget_size(type),
                                      static_cast<double>(H5Dget_storage_size(id)), where);
    switch (H5Tget_class(type)) {
      case H5T_FLOAT:
        require_size(type, where);
        if (H5Tget_size(type) == sizeof(float)) {
          out.values = values<float>(id, H5T_NATIVE_FLOAT, count, where);
        } else {
          out.values = values<double>(id, H5T_NATIVE_DOUBLE, count, where);
        }
        break;
      case H5T_INTEGER:
        require_size(type, where);
        if (H5Tget_sign(type) != H5T_SGN_2) foreign("is a data set of unsigned numbers", where);
        if (H5Tget_size(type) == sizeof(std::int32_t)) {
          out.values = values<std::int32_t>(id, H5T_NATIVE_INT32, count, where);
        } else {
          out.values = values<std::int64_t>(id, H5T_NATIVE_INT64, count, where);
        }
        break;
      case H5T_COMPOUND:
        if (out.extents.size() != 1) foreign("is no table", where);
        out.values = table(id, type, count, where);
        break;
      default:
        foreign("is neither numbers nor a table", where);
    }
    return out;
  }

  template <class T>
  static std::vector<T> values(hid_t id, hid_t type, std::size_t count, const std::string& where) {
    std::vector<T> out(count);
    if (count == 0) return out;
    check(H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), "data set cannot be read",
          where);
    return out;
  }

  static std::vector<H5Column> table(hid_t id, hid_t type, std::size_t count,
                                     const std::string& where) {
    std::vector<H5Column> columns;
    const int members = check(H5Tget_nmembers(type), "table cannot be read", where);
    for (int i = 0; i < members; ++i) {
      const unsigned index = i;
      char* name = H5Tget_member_name(type, index);
      if (name == nullptr) h5::fail("table column", where);
      columns.push_back({name, {}});
      H5free_memory(name);
      const Handle member(H5Tget_member_type(type, index), H5Tclose, "table column", where);
      read_column(id, member, count, columns.back(), where);
    }
    return columns;
  }

  static void read_column(hid_t id, hid_t member, std::size_t count, H5Column& column,
                          const std::string& where) {
    const std::string place = where + ", column '" + column.name + "'";
    switch (H5Tget_class(member)) {
      case H5T_FLOAT:
        column.values = members<double>(id, H5T_NATIVE_DOUBLE, count, column.name, place);
        break;
      case H5T_INTEGER:
        column.values = members<std::int64_t>(id, H5T_NATIVE_INT64, count, column.name, place);
        break;
      case H5T_ARRAY: {
        const hsize_t three = 3;
        const Handle vector(H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &three), H5Tclose, "table type",
                            place);
        column.values = members<std::array<double, 3>>(id, vector, count, column.name, place);
        break;
      }
      case H5T_STRING:
        if (H5Tis_variable_str(member) != 0) foreign("is text of variable length", place);
        column.values = member_texts(id, member, count, column.name, place);
        break;
      default:
        foreign("has another type", place);
    }
  }

  /// The bytes of one column, one after the other.
  static std::vector<char> column_bytes(hid_t id, hid_t member, std::size_t count,
                                        const std::string& name, const std::string& where) {
    const std::size_t size = H5Tget_size(member);
    std::vector<char> buffer(size * count);
    if (count == 0) return buffer;
    const Handle memory(H5Tcreate(H5T_COMPOUND, size), H5Tclose, "table type", where);
    check(H5Tinsert(memory, name.c_str(), 0, member), "table type", where);
    check(H5Dread(id, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer.data()), "table cannot be read",
          where);
    return buffer;
  }

  template <class T>
  static std::vector<T> members(hid_t id, hid_t type, std::size_t count, const std::string& name,
                                const std::string& where) {
    const std::vector<char> bytes = column_bytes(id, type, count, name, where);
    std::vector<T> out(count);
    if (count > 0) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }

  static std::vector<std::string> member_texts(hid_t id, hid_t member, std::size_t count,
                                               const std::string& name, const std::string& where) {
    const std::vector<char> bytes = column_bytes(id, member, count, name, where);
    const std::size_t size = H5Tget_size(member);
    std::vector<std::string> out;
    for (std::size_t i = 0; i < count; ++i) {
      const char* begin = bytes.data() + i * size;
      out.emplace_back(begin, strnlen(begin, size));
    }
    return out;
  }

  std::string name_;
  double file_bytes_;
  double total_ = 0;  ///< bytes of the values met so far
};

/// A damaged file can send HDF5 round in circles: it is stopped after a time that reading a whole
/// file of this size does not take, on a busy machine either.
ChildLimits limits_of(const std::filesystem::path& file) {
  constexpr double kStart_s = 10, kBytesPerSecond = 2e6;
  ChildLimits limits;
  limits.seconds =
      kStart_s + static_cast<double>(std::filesystem::file_size(file)) / kBytesPerSecond;
  return limits;
}

}  // namespace

H5Node read_hdf5(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) throw Error("is no file", file.string());
  const State bytes =
      read_in_child(file, limits_of(file), [&] { return bytes_of(Reader(file).read()); });
  return {std::make_shared<const H5Content>(content_of(bytes)), file.string() + ": /"};
}

}  // namespace geoprior
