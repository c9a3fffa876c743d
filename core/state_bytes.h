#pragma once

#include <Eigen/Core>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/method.h"

namespace geoprior {

/// Appends numbers and matrices to the bytes of a checkpoint. Bytes of this machine: a checkpoint
/// is read by the program that wrote it.
class StateWriter {
 public:
  template <class T>
  void number(T x) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&x, sizeof(T));
  }
  template <class Derived>
  void matrix(const Eigen::PlainObjectBase<Derived>& m) {
    number(m.rows());
    number(m.cols());
    append(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Derived::Scalar));
  }
  /// A list of items without pointers inside, such as vectors and matrices of fixed size.
  template <class T>
  void items(const std::vector<T>& list) {
    number(list.size());
    append(list.data(), list.size() * sizeof(T));
  }
  void bytes(const State& state) {
    number(state.size());
    append(state.data(), state.size());
  }
  void text(std::string_view characters) {
    number(characters.size());
    append(characters.data(), characters.size());
  }
  [[nodiscard]] State take() const {
    State result(bytes_.size());
    if (!bytes_.empty()) std::memcpy(result.data(), bytes_.data(), bytes_.size());
    return result;
  }

 private:
  void append(const void* from, std::size_t size) {
    bytes_.append(static_cast<const char*>(from), size);
  }

  std::string bytes_;  // GCC 12 takes the growth of a vector of bytes for an overflow
};

/// Reads them back in the same order. Bytes that are not what was written are not noticed as such,
/// but nothing beyond their end is read, and no memory is asked for that they cannot fill.
/// @throws Error  when the bytes end early
class StateReader {
 public:
  explicit StateReader(const State& state) : state_(state) {}
  template <class T>
  [[nodiscard]] T number() {
    static_assert(std::is_trivially_copyable_v<T>);
    T x;
    copy(&x, sizeof(T));
    return x;
  }
  /// How many things follow, each written with at least `bytes_each` bytes.
  [[nodiscard]] std::size_t count(std::size_t bytes_each = 1) {
    const auto count = number<std::size_t>();
    if (count > (state_.size() - at_) / bytes_each) throw ends_early();
    return count;
  }
  template <class Derived>
  void matrix(Eigen::PlainObjectBase<Derived>& m) {
    const auto rows = number<Eigen::Index>();
    const auto cols = number<Eigen::Index>();
    require_size(rows, cols, sizeof(typename Derived::Scalar), Derived::RowsAtCompileTime,
                 Derived::ColsAtCompileTime);
    m.resize(rows, cols);
    copy(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Derived::Scalar));
  }
  template <class T>
  void items(std::vector<T>& list) {
    list.resize(count(sizeof(T)));
    copy(list.data(), list.size() * sizeof(T));
  }
  [[nodiscard]] State bytes();
  [[nodiscard]] std::string text();
  /// @throws Error  when there are bytes that nobody has read
  void require_end() const;

 private:
  [[nodiscard]] static Error ends_early();
  void copy(void* to, std::size_t size);
  /// Of a matrix; the compile-time sizes are Eigen::Dynamic where any size will do.
  void require_size(Eigen::Index rows, Eigen::Index cols, std::size_t scalar, int fixed_rows,
                    int fixed_cols) const;

  const State& state_;
  std::size_t at_ = 0;
};

}  // namespace geoprior
