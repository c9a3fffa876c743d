#include <algorithm>
#include <limits>

#include "experiments/formats/hdf5_file.h"
#include "experiments/formats/hdf5_handle.h"

namespace geoprior {

using h5::check;
using h5::Handle;

namespace {

void write_number(hid_t owner, std::string_view name, hid_t file_type, hid_t memory_type,
                  const void* value, const std::string& where) {
  const Handle space = h5::space_of({}, where);
  const Handle attribute(
      H5Acreate2(owner, std::string(name).c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, "attribute cannot be made", where);
  check(H5Awrite(attribute, memory_type, value), "attribute cannot be written", where);
}

Handle open_attribute(hid_t owner, std::string_view name, const std::string& where) {
  return {H5Aopen(owner, std::string(name).c_str(), H5P_DEFAULT), H5Aclose, "attribute is missing",
          where};
}

void read_number(hid_t owner, std::string_view name, hid_t memory_type, void* value,
                 const std::string& where) {
  const Handle attribute = open_attribute(owner, name, where);
  const Handle space(H5Aget_space(attribute), H5Sclose, "attribute cannot be read", where);
  if (!h5::extents_of(space, where).empty()) h5::fail("attribute is no single number", where);
  check(H5Aread(attribute, memory_type, value), "attribute cannot be read", where);
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

std::vector<std::string> read_all_texts(hid_t owner, std::string_view name,
                                        const std::string& where) {
  const Handle attribute = open_attribute(owner, name, where);
  const Handle file_type(H5Aget_type(attribute), H5Tclose, "attribute cannot be read", where);
  if (H5Tget_class(file_type) != H5T_STRING || H5Tis_variable_str(file_type) <= 0) {
    h5::fail("attribute is no text of variable length", where);
  }
  const Handle space(H5Aget_space(attribute), H5Sclose, "attribute cannot be read", where);
  std::size_t count = 1;
  for (const std::size_t n : h5::extents_of(space, where)) count *= n;
  std::vector<char*> texts(count, nullptr);
  if (count == 0) return {};
  const Handle type = h5::text_type(H5T_VARIABLE, where);
  check(H5Aread(attribute, type, texts.data()), "attribute cannot be read", where);
  std::vector<std::string> out;
  for (const char* text : texts) out.emplace_back(text == nullptr ? "" : text);
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
  return out;
}

std::string read_one_text(hid_t owner, std::string_view name, const std::string& where) {
  const std::vector<std::string> texts = read_all_texts(owner, name, where);
  if (texts.size() != 1) h5::fail("attribute is no single text", where);
  return texts.front();
}

herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* client) {
  static_cast<std::vector<std::string>*>(client)->emplace_back(name);
  return 0;
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

std::string H5Group::read_text(std::string_view name) const {
  return read_one_text(id_, name, at(name));
}

std::vector<std::string> H5Group::read_texts(std::string_view name) const {
  return read_all_texts(id_, name, at(name));
}

double H5Group::read_double(std::string_view name) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  read_number(id_, name, H5T_NATIVE_DOUBLE, &value, at(name));
  return value;
}

std::int64_t H5Group::read_int(std::string_view name) const {
  std::int64_t value = 0;
  read_number(id_, name, H5T_NATIVE_INT64, &value, at(name));
  return value;
}

std::uint64_t H5Group::read_unsigned(std::string_view name) const {
  std::uint64_t value = 0;
  read_number(id_, name, H5T_NATIVE_UINT64, &value, at(name));
  return value;
}

std::vector<std::string> H5Group::attributes() const {
  std::vector<std::string> names;
  hsize_t next = 0;
  check(H5Aiterate2(id_, H5_INDEX_NAME, H5_ITER_INC, &next, collect_attribute, &names),
        "attributes cannot be listed", place_);
  std::sort(names.begin(), names.end());
  return names;
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

std::map<std::string, std::string> read_all_attributes(hid_t owner, const std::string& where) {
  std::vector<std::string> names;
  hsize_t next = 0;
  check(H5Aiterate2(owner, H5_INDEX_NAME, H5_ITER_INC, &next, collect_attribute, &names),
        "attributes cannot be listed", where);
  std::map<std::string, std::string> out;
  for (const std::string& name : names) out[name] = read_one_text(owner, name, where + "@" + name);
  return out;
}

}  // namespace h5

}  // namespace geoprior
