#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <vector>

namespace geoprior::assembly {

/// A set of parts of one assembly, a bit a part.
class PartSet {
 public:
  PartSet() = default;
  explicit PartSet(int parts) : words_((parts + 63) / 64) {}

  [[nodiscard]] bool has(int part) const { return words_[part / 64] >> (part % 64) & 1; }
  void add(int part) { words_[part / 64] |= std::uint64_t{1} << (part % 64); }
  void remove(int part) { words_[part / 64] &= ~(std::uint64_t{1} << (part % 64)); }
  [[nodiscard]] int size() const {
    int n = 0;
    for (const std::uint64_t w : words_) n += std::popcount(w);
    return n;
  }
  [[nodiscard]] bool empty() const {
    for (const std::uint64_t w : words_)
      if (w != 0) return false;
    return true;
  }
  [[nodiscard]] bool meets(const PartSet& other) const {
    for (std::size_t i = 0; i < words_.size(); ++i)
      if (words_[i] & other.words_[i]) return true;
    return false;
  }
  PartSet& operator^=(const PartSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] ^= other.words_[i];
    return *this;
  }
  PartSet& operator&=(const PartSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
    return *this;
  }
  PartSet& operator|=(const PartSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }
  /// The parts in order.
  [[nodiscard]] std::vector<int> parts() const {
    std::vector<int> out;
    for (std::size_t i = 0; i < words_.size(); ++i)
      for (std::uint64_t w = words_[i]; w != 0; w &= w - 1)
        out.push_back(static_cast<int>(i) * 64 + std::countr_zero(w));
    return out;
  }
  [[nodiscard]] const std::vector<std::uint64_t>& words() const { return words_; }
  auto operator<=>(const PartSet&) const = default;

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace geoprior::assembly
