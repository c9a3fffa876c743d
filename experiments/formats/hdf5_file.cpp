#include "experiments/formats/hdf5_file.h"

#include <atomic>
#include <vector>

#include "core/error.h"
#include "experiments/formats/atomic_file.h"
#include "experiments/formats/hdf5_handle.h"

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

}  // namespace

void fail(const std::string& what, const std::string& where) {
  std::string stack;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect_message, &stack);
  H5Eclear2(H5E_DEFAULT);
  throw Error(what + (stack.empty() ? "" : ": " + stack), where);
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
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
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

}  // namespace h5

using h5::check;
using h5::Handle;

namespace {

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

std::vector<std::byte> image_of(hid_t file, const std::string& name) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL), "cannot be written", name);
  const ssize_t size = check(H5Fget_file_image(file, nullptr, 0), "cannot be written", name);
  std::vector<std::byte> image(static_cast<std::size_t>(size));
  check(H5Fget_file_image(file, image.data(), image.size()), "cannot be written", name);
  return image;
}

herr_t collect_link(hid_t, const char* name, const H5L_info_t*, void* client) {
  static_cast<std::vector<std::string>*>(client)->push_back(decoded(name));
  return 0;
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

H5Group H5Group::open_group(std::string_view name) const {
  const std::string where = at(name);
  Handle id(H5Gopen2(id_, h5::encoded(name).c_str(), H5P_DEFAULT), H5Gclose, "group is missing",
            where);
  return {id.give_up(), where};
}

bool H5Group::has(std::string_view name) const {
  return check(H5Lexists(id_, h5::encoded(name).c_str(), H5P_DEFAULT), "cannot be read", at(name)) >
         0;
}

std::vector<std::string> H5Group::children() const {
  std::vector<std::string> names;
  hsize_t next = 0;
  check(H5Literate(id_, H5_INDEX_NAME, H5_ITER_INC, &next, collect_link, &names),
        "group cannot be listed", place_);
  return names;
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

H5Array H5Group::read_array(std::string_view name) const {
  const std::string where = at(name);
  const Handle data(H5Dopen2(id_, h5::encoded(name).c_str(), H5P_DEFAULT), H5Dclose,
                    "data set is missing", where);
  const Handle space(H5Dget_space(data), H5Sclose, "data set cannot be read", where);
  H5Array array;
  array.extents = h5::extents_of(space, where);
  array.attributes = h5::read_all_attributes(data, where);
  std::size_t count = 1;
  for (const std::size_t n : array.extents) count *= n;
  array.values.resize(count);
  if (count == 0) return array;
  check(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()),
        "data set cannot be read", where);
  return array;
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

H5File H5File::open_for_reading(const std::filesystem::path& file) {
  h5::silence();
  if (!std::filesystem::is_regular_file(file)) throw Error("is no file", file.string());
  Handle id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
            "is no HDF5 file, or is damaged", file.string());
  return {id.give_up(), file.string()};
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

}  // namespace geoprior
