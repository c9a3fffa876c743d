#include "solvers/assembly/cycle_space.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "core/random.h"

namespace geoprior::assembly {

CycleSpace::CycleSpace(const Assembly& assembly) : parts_(static_cast<int>(assembly.parts.size())) {
  grow_forest(assembly);
  sum_columns(assembly);
  sort_into_classes();
}

void CycleSpace::grow_forest(const Assembly& assembly) {
  std::vector<std::vector<std::pair<int, int>>> neighbours(parts_);  // part, connection
  for (std::size_t c = 0; c < assembly.connections.size(); ++c) {
    const auto [a, b] = assembly.connections[c];
    neighbours[a.part].emplace_back(b.part, static_cast<int>(c));
    neighbours[b.part].emplace_back(a.part, static_cast<int>(c));
  }
  parent_.assign(parts_, -1);
  parent_connection_.assign(parts_, -1);
  component_of_.assign(parts_, -1);
  for (int root = 0; root < parts_; ++root) {
    if (component_of_[root] >= 0) continue;
    const int component = static_cast<int>(components_.size());
    components_.emplace_back(parts_);
    component_of_[root] = component;
    order_.push_back(root);
    for (std::size_t next = order_.size() - 1; next < order_.size(); ++next) {
      const int part = order_[next];
      components_.back().add(part);
      for (const auto& [there, connection] : neighbours[part]) {
        if (component_of_[there] >= 0) continue;
        component_of_[there] = component;
        parent_[there] = part;
        parent_connection_[there] = connection;
        order_.push_back(there);
      }
    }
  }
}

void CycleSpace::sum_columns(const Assembly& assembly) {
  const std::size_t count = assembly.connections.size();
  std::vector<char> in_forest(count, 0);
  for (const int c : parent_connection_)
    if (c >= 0) in_forest[c] = 1;
  const std::size_t cycles = count - std::count(in_forest.begin(), in_forest.end(), 1);
  const std::size_t words = (cycles + 63) / 64;
  columns_.assign(count, Column(words, 0));
  hashes_.assign(count, 0);
  below_.assign(count, PartSet());
  std::vector<Column> at_part(parts_, Column(words, 0));
  std::vector<std::uint64_t> hash_at_part(parts_, 0);
  RandomStream random(0, "cycle space");
  std::size_t cycle = 0;
  for (std::size_t c = 0; c < count; ++c) {
    if (in_forest[c]) continue;
    const std::uint64_t bit = std::uint64_t{1} << (cycle % 64);
    columns_[c][cycle / 64] = bit;
    hashes_[c] = std::uint64_t{random.next()} << 32 | random.next();
    // On the way between its ends, and on no other, a connection of the forest has one of them
    // below it: both cancel above.
    for (const int part : {assembly.connections[c].a.part, assembly.connections[c].b.part}) {
      at_part[part][cycle / 64] ^= bit;
      hash_at_part[part] ^= hashes_[c];
    }
    ++cycle;
  }
  std::vector<PartSet> under(parts_, PartSet(parts_));
  for (std::size_t i = order_.size(); i-- > 0;) {
    const int part = order_[i], c = parent_connection_[part];
    under[part].add(part);
    if (c < 0) continue;
    columns_[c] = at_part[part];
    hashes_[c] = hash_at_part[part];
    below_[c] = under[part];
    for (std::size_t w = 0; w < words; ++w) at_part[parent_[part]][w] ^= at_part[part][w];
    hash_at_part[parent_[part]] ^= hash_at_part[part];
    under[parent_[part]] |= under[part];
    under[part] = PartSet();
  }
}

void CycleSpace::sort_into_classes() {
  const int count = static_cast<int>(columns_.size());
  class_of_.assign(count, -1);
  std::map<Column, std::vector<int>> by_column;
  for (int c = 0; c < count; ++c) by_column[columns_[c]].push_back(c);
  std::vector<std::vector<int>> classes;
  for (auto& [column, members] : by_column) {
    const bool is_zero =
        std::all_of(column.begin(), column.end(), [](std::uint64_t w) { return w == 0; });
    if (is_zero)
      bridges_ = std::move(members);
    else
      classes.push_back(std::move(members));
  }
  std::sort(classes.begin(), classes.end());
  for (std::size_t k = 0; k < classes.size(); ++k)
    for (const int c : classes[k]) class_of_[c] = static_cast<int>(k);
  classes_ = std::move(classes);
}

bool CycleSpace::sum_to_zero(std::span<const int> classes) const {
  const std::size_t words = columns_[classes_[classes[0]][0]].size();
  for (std::size_t w = 0; w < words; ++w) {
    std::uint64_t sum = 0;
    for (const int k : classes) sum ^= columns_[classes_[k][0]][w];
    if (sum != 0) return false;
  }
  return true;
}

template <class Visit>
void CycleSpace::for_each_triple(Visit visit) const {
  const int count = static_cast<int>(classes_.size());
  std::unordered_multimap<std::uint64_t, int> by_hash;
  for (int k = 0; k < count; ++k) by_hash.emplace(hashes_[classes_[k][0]], k);
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const auto [first, last] =
          by_hash.equal_range(hashes_[classes_[a][0]] ^ hashes_[classes_[b][0]]);
      for (auto c = first; c != last; ++c) {
        const std::array<int, 3> triple{a, b, c->second};
        if (c->second > b && sum_to_zero(triple)) visit(triple);
      }
    }
}

template <class Visit>
void CycleSpace::for_each_quadruple(Visit visit) const {
  const int count = static_cast<int>(classes_.size());
  using Pair = std::pair<std::uint64_t, std::pair<int, int>>;
  std::vector<Pair> pairs;
  pairs.reserve(static_cast<std::size_t>(count) * count / 2);
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      pairs.push_back({hashes_[classes_[a][0]] ^ hashes_[classes_[b][0]], {a, b}});
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t first = 0, last = 0; first < pairs.size(); first = last) {
    while (last < pairs.size() && pairs[last].first == pairs[first].first) ++last;
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t j = i + 1; j < last; ++j) {
        const auto [a, b] = pairs[i].second;
        const auto [c, d] = pairs[j].second;
        // Each quadruple is three pairs of pairs: the one with the least class in the first, and
        // the next least beside it, is taken.
        const std::array<int, 4> quadruple{a, b, c, d};
        if (b < c && sum_to_zero(quadruple)) visit(quadruple);
      }
  }
}

namespace {

/// All choices of one connection a class.
void for_each_choice(std::span<const int> classes, const std::vector<std::vector<int>>& members,
                     const CycleSpace::BondVisitor& visit) {
  std::array<std::size_t, 4> at{};
  std::array<int, 4> bond{};
  const std::size_t n = classes.size();
  while (true) {
    for (std::size_t i = 0; i < n; ++i) bond[i] = members[classes[i]][at[i]];
    std::sort(bond.begin(), bond.begin() + static_cast<std::ptrdiff_t>(n));
    visit({bond.data(), n});
    std::size_t i = 0;
    while (i < n && ++at[i] == members[classes[i]].size()) at[i++] = 0;
    if (i == n) return;
  }
}

}  // namespace

void CycleSpace::for_each_bond(int size, const BondVisitor& visit) const {
  const auto choices = [&](const auto& classes) { for_each_choice(classes, classes_, visit); };
  switch (size) {
    case 1:
      for (const int bridge : bridges_) visit({&bridge, 1});
      return;
    case 2:
      for (const std::vector<int>& members : classes_)
        for (std::size_t i = 0; i < members.size(); ++i)
          for (std::size_t j = i + 1; j < members.size(); ++j)
            visit(std::array{members[i], members[j]});
      return;
    case 3:
      return for_each_triple(choices);
    case 4:
      return for_each_quadruple(choices);
    default:
      throw Error("boundaries of " + std::to_string(size) + " connections are not looked for",
                  "cycle space", "1 to 4");
  }
}

double CycleSpace::bond_count(int size) const {
  double count = 0;
  const auto product = [&](const auto& classes) {
    double n = 1;
    for (const int k : classes) n *= static_cast<double>(classes_[k].size());
    count += n;
  };
  if (size == 1) return static_cast<double>(bridges_.size());
  if (size == 2) {
    for (const std::vector<int>& members : classes_) {
      const auto n = static_cast<double>(members.size());
      count += n * (n - 1) / 2;
    }
  } else if (size == 3) {
    for_each_triple(product);
  } else {
    for_each_quadruple(product);
  }
  return count;
}

double CycleSpace::bytes_needed(int size) const {
  const auto classes = static_cast<double>(classes_.size());
  return size < 4 ? 64 * classes : 16 * classes * classes / 2;
}

PartSet CycleSpace::far_side(std::span<const int> bond) const {
  PartSet side(parts_);
  for (const int c : bond)
    if (!below_[c].words().empty()) side ^= below_[c];
  return side;
}

PartSet CycleSpace::rest_of_component(const PartSet& side) const {
  PartSet rest = components_[component_of_[side.parts().front()]];
  rest ^= side;
  return rest;
}

}  // namespace geoprior::assembly
