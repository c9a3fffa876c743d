#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/method.h"
#include "testbed/formats/hdf5/file.h"

namespace geoprior {

/// An attribute of a group or a data set: texts (one or a list), or one number.
using H5Attribute = std::variant<std::vector<std::string>, double, std::int64_t, std::uint64_t>;

/// A data set: numbers with their extents, or a table, whose columns have equal lengths.
struct H5Data {
  std::vector<std::size_t> extents;
  std::variant<std::vector<double>, std::vector<float>, std::vector<std::int32_t>,
               std::vector<std::int64_t>, std::vector<H5Column>>
      values;
  std::map<std::string, H5Attribute> attributes;
};

/// What a group of a file holds, and the groups inside it.
struct H5Content {
  std::map<std::string, H5Attribute> attributes;
  std::map<std::string, H5Data> data;
  std::map<std::string, H5Content> groups;
};

/// Content as bytes, to cross from one process to another.
State bytes_of(const H5Content& content);
H5Content content_of(const State& bytes);

/// A group of a file that was read: as `H5Group`, but nothing of HDF5 is behind it.
///
/// Every question that the file has no answer to throws Error with file and place.
class H5Node {
 public:
  H5Node(std::shared_ptr<const H5Content> content, std::string place)
      : content_(std::move(content)), place_(std::move(place)) {}

  [[nodiscard]] H5Node open_group(std::string_view name) const;
  /// "file: /group", for messages.
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] bool has(std::string_view name) const;
  /// Names of the groups and data sets inside, sorted.
  [[nodiscard]] std::vector<std::string> children() const;

  /// Names of the attributes, sorted.
  [[nodiscard]] std::vector<std::string> attributes() const;
  [[nodiscard]] std::string read_text(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> read_texts(std::string_view name) const;
  [[nodiscard]] double read_double(std::string_view name) const;
  [[nodiscard]] std::int64_t read_int(std::string_view name) const;
  [[nodiscard]] std::uint64_t read_unsigned(std::string_view name) const;

  /// A data set of float64 with its text attributes.
  [[nodiscard]] H5Array read_array(std::string_view name) const;
  /// A data set of T with `rank` extents.
  template <class T>
  [[nodiscard]] H5Block<T> read_block(std::string_view name, std::size_t rank) const;
  /// All columns of a table.
  [[nodiscard]] const std::vector<H5Column>& read_table(std::string_view name) const;
  /// Reads the columns of these names; the alternatives that `columns` hold say the types.
  void read_table(std::string_view name, std::vector<H5Column>& columns) const;

 private:
  [[nodiscard]] std::string at(std::string_view name) const;
  [[nodiscard]] const H5Attribute& attribute(std::string_view name) const;
  [[nodiscard]] const H5Data& data(std::string_view name) const;
  template <class T>
  [[nodiscard]] T number(std::string_view name) const;

  std::shared_ptr<const H5Content> content_;
  std::string place_;
};

/// Reads a whole file, in a process of its own: HDF5 1.10 crashes on many a damaged file, and one
/// made for the purpose may do worse.
///
/// Only what this program writes is accepted: groups that have one name each, no links to other
/// places and files, values inside the file, no filters but shuffle and zlib, and no data set that
/// says to be larger than what the file can hold.
/// @throws Error  naming the file, and the place in it where there is one
H5Node read_hdf5(const std::filesystem::path& file);

}  // namespace geoprior
