#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace geoprior {

/// One column of a table: its values decide the type in the file (float64, int64, float64[3],
/// UTF-8 of fixed length).
struct H5Column {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::array<double, 3>>,
               std::vector<std::string>>
      values;
};

/// A data set of float64 with its extents (none for a scalar), rows first, and its text attributes.
struct H5Array {
  std::vector<std::size_t> extents;
  std::vector<double> values;
  std::map<std::string, std::string> attributes;
};

/// A large data set of numbers with its extents, rows first: float, double, std::int32_t or
/// std::int64_t.
template <class T>
struct H5Block {
  std::vector<std::size_t> extents;
  std::vector<T> values;
};

/// A group of a file that is written. Names are percent-encoded where HDF5 does not allow them
/// (`/`).
///
/// The library's own printing of errors is off; every failure throws Error with the file, the place
/// in it and the text of the library's error stack.
class H5Group {
 public:
  H5Group(H5Group&& other) noexcept;
  H5Group& operator=(H5Group&& other) noexcept;
  H5Group(const H5Group&) = delete;
  H5Group& operator=(const H5Group&) = delete;
  ~H5Group();

  H5Group create_group(std::string_view name);

  void write_attribute(std::string_view name, const std::string& text);
  void write_attribute(std::string_view name, const std::vector<std::string>& texts);
  void write_attribute(std::string_view name, double value);
  void write_attribute(std::string_view name, std::int64_t value);
  void write_attribute(std::string_view name, std::uint64_t value);

  void write_array(std::string_view name, const H5Array& array);
  /// A data set rows x columns of float64 with the attribute `columns`, in chunks compressed by
  /// zlib. `values` are row by row.
  void write_matrix(std::string_view name, const std::vector<std::string>& columns,
                    const std::vector<double>& values);
  /// A data set in chunks of one entry of the first extent, shuffled and compressed by zlib;
  /// without the time at which it was made, so that equal values give equal bytes.
  template <class T>
  void write_block(std::string_view name, const std::vector<std::size_t>& extents,
                   std::span<const T> values);
  /// Columns of equal length become one compound data set.
  void write_table(std::string_view name, const std::vector<H5Column>& columns);

 private:
  friend class H5File;
  H5Group(std::int64_t id, std::string place) : id_(id), place_(std::move(place)) {}
  [[nodiscard]] std::string at(std::string_view name) const;

  std::int64_t id_;    ///< hid_t; this header does not include HDF5's
  std::string place_;  ///< "file: /group", for messages
};

/// An HDF5 file that is written, in the default file format; `read_hdf5` reads one.
///
/// The file is built in memory and saved as a whole: HDF5 1.10 crashes the program when the disk
/// refuses a write while it closes a file.
class H5File {
 public:
  static H5File create();
  H5File(H5File&& other) noexcept;
  H5File& operator=(H5File&& other) noexcept;
  H5File(const H5File&) = delete;
  H5File& operator=(const H5File&) = delete;
  ~H5File();

  [[nodiscard]] H5Group root() const;
  /// The whole of a created file. Groups should be closed before.
  [[nodiscard]] std::vector<std::byte> bytes() const;
  /// Writes a created file: temporary + fsync + rename. Groups should be closed before.
  /// @throws Error  naming the file and the system's reason
  void save(const std::filesystem::path& file) const;

 private:
  H5File(std::int64_t id, std::string name) : id_(id), name_(std::move(name)) {}

  std::int64_t id_;
  std::string name_;
};

}  // namespace geoprior
