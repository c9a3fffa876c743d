#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace geoprior::embryo {

/// A table from 64-bit keys to small values: open addressing, linear probing, grown by doubling.
/// Nothing is removed, and nothing is read in the order of the table, so that results do not depend
/// on it. About 10 ns a look-up.
template <class Value>
class LatticeTable {
 public:
  explicit LatticeTable(std::size_t expected = 1024) { resize(std::bit_ceil(2 * expected + 16)); }

  /// The value of a key, and whether it was just made (then it is what `Value{}` is). The reference
  /// holds until the next call.
  struct Entry {
    Value& value;
    bool fresh;
  };
  Entry operator[](std::uint64_t key) {
    if (2 * count_ > slots_.size()) grow();
    Slot& slot = find(key);
    if (slot.key == key) return {slot.value, false};
    slot.key = key;
    ++count_;
    return {slot.value, true};
  }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kEmpty;
    Value value{};
  };

  Slot& find(std::uint64_t key) {
    std::size_t i = (key * 0x9e3779b97f4a7c15ULL) >> shift_;
    while (slots_[i].key != key && slots_[i].key != kEmpty) i = (i + 1) & (slots_.size() - 1);
    return slots_[i];
  }
  void resize(std::size_t size) {
    slots_.assign(size, Slot{});
    shift_ = 64 - std::countr_zero(size);
  }
  void grow() {
    std::vector<Slot> old;
    old.swap(slots_);
    resize(2 * old.size());
    for (const Slot& slot : old)
      if (slot.key != kEmpty) find(slot.key) = slot;
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
  int shift_ = 0;
};

}  // namespace geoprior::embryo
