#pragma once

// Inside of the HDF5 wrapper: includes the library's header, so only hdf5_*.cpp use it.

#include <hdf5.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace geoprior::h5 {

/// Throws Error with `where`, what failed and the innermost messages of HDF5's error stack.
[[noreturn]] void fail(const std::string& what, const std::string& where);

/// HDF5 prints its error stack by default; every entry point of the wrapper turns that off.
void silence();

/// Any HDF5 identifier, released when it goes out of scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*release)(hid_t), const std::string& what, const std::string& where)
      : id_(id), release_(release) {
    if (id_ < 0) fail(what, where);
  }
  ~Handle() {
    if (id_ >= 0) release_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), release_(other.release_) {}
  Handle& operator=(Handle&&) = delete;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }  // the C API takes it everywhere
  hid_t give_up() { return std::exchange(id_, -1); }

 private:
  hid_t id_;
  herr_t (*release_)(hid_t);
};

/// Throws unless `status` is non-negative; returns it.
template <class Status>
Status check(Status status, const std::string& what, const std::string& where) {
  if (status < 0) fail(what, where);
  return status;
}

/// UTF-8 text: of variable length, or of `size` bytes padded with zeros.
Handle text_type(std::size_t size, const std::string& where);

/// A simple data space; a scalar for no extents.
Handle space_of(const std::vector<std::size_t>& extents, const std::string& where);

/// Extents of a data space (empty for a scalar).
std::vector<std::size_t> extents_of(hid_t space, const std::string& where);

/// Percent-encodes what the name of a link cannot hold.
std::string encoded(std::string_view name);
std::string decoded(std::string_view name);

/// Text attributes of a data set.
void write_text(hid_t owner, const std::string& name, const std::string& text,
                const std::string& where);
void write_text_list(hid_t owner, std::string_view name, const std::vector<std::string>& texts,
                     const std::string& where);

}  // namespace geoprior::h5
