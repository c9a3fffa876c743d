#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace geoprior::assembly {

/// 128 bits of a canonical form: equal for isomorphic graphs, different for others but for a
/// collision of two independent hashes of 64 bits.
struct CanonicalKey {
  std::array<std::uint64_t, 2> words{};
  auto operator<=>(const CanonicalKey&) const = default;
};
struct CanonicalHash {
  std::size_t operator()(const CanonicalKey& key) const { return key.words[0]; }
};

/// Two independent hashes of 64 bits of a list of numbers: multiply and fold (Fowler, Noll, Vo, and
/// a fold), and the mixing of splitmix64.
class KeyHash {
 public:
  void add(int number) {
    const auto w = static_cast<std::uint64_t>(static_cast<std::uint32_t>(number));
    a_ = (a_ ^ w) * 0x100000001b3ULL;
    a_ ^= a_ >> 29;
    b_ += w + 0x9e3779b97f4a7c15ULL;
    b_ = (b_ ^ b_ >> 30) * 0xbf58476d1ce4e5b9ULL;
    b_ = (b_ ^ b_ >> 27) * 0x94d049bb133111ebULL;
    b_ ^= b_ >> 31;
  }
  [[nodiscard]] CanonicalKey key() const { return {{a_, b_}}; }

 private:
  std::uint64_t a_ = 0xcbf29ce484222325ULL, b_ = 0x9e3779b97f4a7c15ULL;
};

}  // namespace geoprior::assembly
