#pragma once

#include <algorithm>
#include <vector>

#include "models/assembly/graph/ported_graph.h"

namespace geoprior::assembly {

/// How the ends of a boundary have to agree.
enum class Matching {
  /// Each end of the new inside is of a type that was seen joined with the end of the outside.
  observed,
  /// Each connection is of the same type as the one that it replaces: both ends.
  strict,
};

/// Which ports are alike, and which were seen joined in the models of a set.
///
/// Ports of a type that a symmetry of it exchanges are of one class; without symmetries each port
/// is a class of its own. The compatibility matrix of the thesis, on (label, port).
class Compatibility {
 public:
  Compatibility(const AssemblySet& set, bool with_symmetries);

  [[nodiscard]] int class_count() const { return count_; }
  [[nodiscard]] int port_class(int type, int port) const { return class_of_[first_[type] + port]; }
  [[nodiscard]] int port_class(const Assembly& assembly, PortRef ref) const {
    return port_class(assembly.parts[ref.part].type, ref.port);
  }
  /// Whether some model joins ports of these classes.
  [[nodiscard]] bool observed(int a, int b) const {
    return std::binary_search(seen_with_[a].begin(), seen_with_[a].end(), b);
  }
  /// The classes that were seen joined with this one, in increasing order.
  [[nodiscard]] const std::vector<int>& seen_with(int a) const { return seen_with_[a]; }

 private:
  int count_ = 0;
  std::vector<int> first_, class_of_;
  std::vector<std::vector<int>> seen_with_;  ///< of a class, in increasing order
};

}  // namespace geoprior::assembly
