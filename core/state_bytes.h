#pragma once

#include <Eigen/Core>
#include <cstring>
#include <string>
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

/// Reads them back in the same order. @throws Error  when the bytes end early
class StateReader {
 public:
  explicit StateReader(const State& state) : state_(state) {}
  template <class T>
  [[nodiscard]] T number() {
    T x;
    copy(&x, sizeof(T));
    return x;
  }
  template <class Derived>
  void matrix(Eigen::PlainObjectBase<Derived>& m) {
    const auto rows = number<Eigen::Index>();
    const auto cols = number<Eigen::Index>();
    m.resize(rows, cols);
    copy(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Derived::Scalar));
  }
  template <class T>
  void items(std::vector<T>& list) {
    const auto count = number<std::size_t>();
    if (count > (state_.size() - at_) / sizeof(T))
      throw Error("ends early", "checkpoint", "an unharmed one");
    list.resize(count);
    copy(list.data(), count * sizeof(T));
  }
  [[nodiscard]] State bytes() {
    State result(number<std::size_t>());
    copy(result.data(), result.size());
    return result;
  }

 private:
  void copy(void* to, std::size_t size) {
    if (size > state_.size() - at_) throw Error("ends early", "checkpoint", "an unharmed one");
    if (size > 0) std::memcpy(to, state_.data() + at_, size);
    at_ += size;
  }

  const State& state_;
  std::size_t at_ = 0;
};

}  // namespace geoprior
