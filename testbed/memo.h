#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <type_traits>
#include <utility>

namespace geoprior {

/// 128-bit hash of content: what a remembered value depends on, so that it cannot go stale.
struct ContentKey {
  std::uint64_t a = 0x243F6A8885A308D3ULL;
  std::uint64_t b = 0x13198A2E03707344ULL;
  bool operator==(const ContentKey&) const = default;

  void add(std::uint64_t word) {
    a = std::rotl(a ^ word, 29) * 0x9E3779B97F4A7C15ULL;
    b = std::rotl(b + word, 31) * 0xC2B2AE3D27D4EB4FULL ^ (b >> 33);
  }
  template <class Matrix>
  void add_matrix(const Matrix& m) {
    add(static_cast<std::uint64_t>(m.size()));
    for (Eigen::Index i = 0; i < m.size(); ++i) {
      if constexpr (std::is_same_v<typename Matrix::Scalar, double>) {
        add(std::bit_cast<std::uint64_t>(m.data()[i]));
      } else {
        add(static_cast<std::uint64_t>(m.data()[i]));
      }
    }
  }
};

/// Remembers the last `Remembered` values of one expensive quantity that several frames, variants
/// or groups of metrics share: what stays at rest, the frame of a reference. (The rows of one group
/// need none: a group measures once, testbed/metric_rows.h.) Two threads that miss at once compute
/// the same value twice, which is harmless.
template <class T, std::size_t Remembered = 1024>
class Memo {
 public:
  T get(const ContentKey& key, const std::function<T()>& compute) {
    {
      const std::lock_guard lock(mutex_);
      for (const auto& [known, value] : entries_) {
        if (known == key) return value;
      }
    }
    T value = compute();
    const std::lock_guard lock(mutex_);
    entries_.emplace_front(key, value);
    if (entries_.size() > Remembered) entries_.pop_back();
    return value;
  }

 private:
  std::mutex mutex_;
  std::deque<std::pair<ContentKey, T>> entries_;
};

}  // namespace geoprior
