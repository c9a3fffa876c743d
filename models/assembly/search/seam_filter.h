#pragma once

#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "models/assembly/exchange/replacement.h"
#include "models/assembly/isomorphism/canonical.h"
#include "models/assembly/search/input.h"

namespace geoprior::assembly {

/// Finds out before an assembly is built that it would break a rule: what two substructures and
/// their seams tell. What it lets through may still break one.
///
/// - *Counts*: parts, entries, exits and the bill of materials, by what goes and what comes.
/// - *Seams* that one piece of the host holds: the inner ports must lie to each other as the outer
///   ones do (`seam_residual`).
/// - *Sameness*: what comes is what goes, at the very same seams: the assembly would be the host.
/// - *Floor*: parts that stand on it hold a piece at its height. Seams to pieces that are so held,
///   and a copied piece that is, must agree on how far the copied piece is lifted; asked where the
///   seams turn it about the vertical only. Models are on the floor (`put_on_floor`).
class SeamFilter {
 public:
  SeamFilter(const AssemblyInput& input, const JointTolerance& tolerance, bool symmetries);

  /// Replacements of another host come.
  void begin(const Assembly& host);

  enum class Verdict { passes, counts, floor, seams, same };
  Verdict look(const Assembly& host, const Replacement& replacement);
  /// The last of these questions alone: whether the assembly would be the host.
  bool is_same(const Assembly& host, const Replacement& replacement);

 private:
  /// Labels that rules count, of some parts.
  struct Counts {
    int parts = 0, entries = 0, exits = 0;
    std::vector<int> bill;
  };
  /// What is asked of one removed, or inserted, substructure.
  struct Looked {
    Counts counts;
    bool stands = false;            ///< the copied piece has grounded parts
    std::vector<int> pieces;        ///< of the host: the piece at each seam
    std::vector<char> held;         ///< of the host: whether grounded parts hold that piece
    std::vector<double> heights;    ///< of the ports at the seams
    bool has_shared_piece = false;  ///< two seams lead to one piece
    /// Canonical keys, by the order of the seams; made when they are asked for.
    std::map<std::vector<int>, CanonicalKey> keys;
  };
  void look_at_host(const Assembly& host, const Substructure& removed);
  Looked& look_at_donor(int number, int donor, const Substructure& inserted);
  [[nodiscard]] Counts counts_of(const Assembly& assembly, const PartSet* parts) const;
  [[nodiscard]] bool counts_hold(const Counts& inserted) const;
  [[nodiscard]] bool floor_holds(const Assembly& host, const Replacement& replacement,
                                 const Looked& inserted) const;

  /// Looks at the host again where the substructure is another one.
  void turn_to(const Assembly& host, const Replacement& replacement);
  [[nodiscard]] bool is_same(const Assembly& host, const Replacement& replacement,
                             Looked& inserted);

  const AssemblyInput& input_;
  JointTolerance tolerance_;
  bool symmetries_;
  std::vector<char> is_entry_, is_exit_, is_grounded_;  ///< of a type
  std::vector<int> bill_of_;                            ///< of a type; -1: not limited
  std::optional<int> host_number_;
  Counts whole_;
  Looked removed_;
  std::unordered_map<int, Looked> inserted_;
  Looked unnumbered_;
};

}  // namespace geoprior::assembly
