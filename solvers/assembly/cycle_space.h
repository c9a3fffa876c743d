#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "models/assembly/graph/part_set.h"
#include "models/assembly/graph/ported_graph.h"

namespace geoprior::assembly {

/// Which connections close which cycles, and from that the cuts of an assembly: the dual graph of
/// the thesis, whose nodes are the connections, with what of it decides how parts come off.
///
/// A spanning forest and the connections beside it give a basis of cycles. A connection's *column*
/// says which of them it is on. A set of connections is a cut (all that join some parts with the
/// others) exactly when its columns sum to zero over GF(2), and a *bond*, a cut that holds no
/// smaller one, exactly when no part of it sums to zero, too; then both sides of it hang together.
///
/// Candidates come from hashes, random 64 bit numbers for the cycles, summed likewise: connections
/// of equal hash are cuts of two, and so on. Sums of columns are compared for each, so that equal
/// hashes of other cuts cannot pass.
/// Source: Pritchard and Thurimella 2011, "Fast computation of small cuts via cycle space
/// sampling".
class CycleSpace {
 public:
  explicit CycleSpace(const Assembly& assembly);

  [[nodiscard]] int part_count() const { return parts_; }
  [[nodiscard]] const std::vector<int>& bridges() const { return bridges_; }
  /// Connections of one column, any pair of which is a cut; a class may have one alone.
  [[nodiscard]] const std::vector<std::vector<int>>& classes() const { return classes_; }

  /// Bonds of exactly that size (1 to 4): each class by class, connections in increasing order.
  using BondVisitor = std::function<void(std::span<const int>)>;
  void for_each_bond(int size, const BondVisitor& visit) const;
  /// How many of these there are, without making them.
  [[nodiscard]] double bond_count(int size) const;
  /// Bytes that bonds of that size need while they are looked for.
  [[nodiscard]] double bytes_needed(int size) const;

  /// One side of a bond: that without the first part of the component.
  [[nodiscard]] PartSet far_side(std::span<const int> bond) const;
  /// The other parts of the component of a part.
  [[nodiscard]] PartSet rest_of_component(const PartSet& side) const;
  /// The class of a connection; -1 for a bridge.
  [[nodiscard]] int class_of(int connection) const { return class_of_[connection]; }

 private:
  using Column = std::vector<std::uint64_t>;
  void grow_forest(const Assembly& assembly);
  void sum_columns(const Assembly& assembly);
  void sort_into_classes();
  template <class Visit>
  void for_each_triple(Visit visit) const;
  template <class Visit>
  void for_each_quadruple(Visit visit) const;
  [[nodiscard]] bool sum_to_zero(std::span<const int> classes) const;

  int parts_ = 0;
  std::vector<int> order_, parent_, parent_connection_;  ///< of a part
  std::vector<PartSet> below_;                           ///< of a connection of the forest
  std::vector<PartSet> components_;
  std::vector<int> component_of_;
  std::vector<Column> columns_;
  std::vector<std::uint64_t> hashes_;
  std::vector<int> bridges_;
  std::vector<std::vector<int>> classes_;
  std::vector<int> class_of_;
};

}  // namespace geoprior::assembly
