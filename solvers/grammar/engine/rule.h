#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solvers/grammar/engine/symbol.h"
#include "solvers/grammar/engine/transaction.h"

namespace geoprior::grammar {

class Derivation;

/// What a rule sees and may do while it is applied to a batch: elements of one type, asked at once
/// by one element above (down) or below (up).
///
/// Terminals write the state of elements of the batch; symbols ask others: `down` the children of
/// elements of the batch, `up` the parent. In the phase up the batch is one element.
class RuleCall {
 public:
  [[nodiscard]] std::span<const int> elements() const { return elements_; }
  [[nodiscard]] DeltaKind kind() const { return delta_->kind; }
  [[nodiscard]] const Delta& delta() const { return *delta_; }
  [[nodiscard]] Origin origin() const { return origin_; }
  [[nodiscard]] Phase phase() const { return phase_; }
  /// Number of the derivation: what a rule prepares for one is worth nothing in the next.
  [[nodiscard]] std::uint64_t derivation() const;
  /// The deformation of element `i` of the batch: of kinds that have one an element.
  [[nodiscard]] const Eigen::Affine3d& transform(std::size_t i) const {
    return transforms_.empty() ? delta_->transform : transforms_[i];
  }
  /// The element that sent this: the child in the phase up, the parent in the phase down; -1 of the
  /// user.
  [[nodiscard]] int sender() const { return sender_; }
  /// The element that the user edited. Its own edit is a fact that the phase down has to keep.
  [[nodiscard]] int edited() const;
  /// Whether a tag of these elements turned what was asked for into a rigid motion.
  [[nodiscard]] bool follows() const { return follows_; }

  /// The state as it is by now, and what it was when the derivation began (bit for bit).
  [[nodiscard]] const Hierarchy& now() const;
  [[nodiscard]] Pose pose_before(int element) const;
  [[nodiscard]] double parameter_before(int element, int number) const;
  [[nodiscard]] std::span<const Eigen::Vector3d> points_before(int element) const;
  /// Key points as they were, in the world; appended.
  void keys_before(int element, std::vector<Eigen::Vector3d>& out) const;

  // Terminals: elements of the batch, or those that this call spawned.
  void set_pose(int element, const Pose& pose);
  /// @throws Error  naming rule, element and parameter: not finite, or out of its range
  void set_parameter(int element, int number, double value);
  /// The element's own points, to be written.
  std::span<Eigen::Vector3d> points(int element);
  /// A new child of an element of the batch. Not from a parallel rule.
  int spawn(int type, int parent, const Pose& pose, std::span<const double> parameters);
  /// Takes an element of the batch, or a child of one, away, with all that is below it. Not from a
  /// parallel rule.
  void remove(int element);
  /// Shows an element again, or for the first time, that was not present. As `remove`.
  void restore(int element);

  // Symbols. Not from a parallel rule.
  /// Asks children of `parent`, an element of the batch. Children that are not present are left
  /// out.
  /// @param transforms  one a child, for kinds that have one an element; empty: that of `delta`
  void down(int parent, std::vector<int> children, const Delta& delta,
            std::vector<Eigen::Affine3d> transforms = {});
  /// `down` of all children.
  void down(int parent, const Delta& delta);
  /// Phase up: asks the parent.
  void up(const Delta& delta);
  /// Phase up: this element bounds the locality; the phase down begins here with `delta`.
  void absorb(const Delta& delta);

 private:
  friend class Derivation;
  RuleCall(Derivation& derivation, std::span<const int> elements)
      : derivation_(derivation), elements_(elements) {}
  void require_own(int element) const;
  void require_serial(const char* what) const;

  Derivation& derivation_;
  std::span<const int> elements_;
  std::span<const Eigen::Affine3d> transforms_;
  const Delta* delta_ = nullptr;
  Origin origin_ = Origin::user;
  Phase phase_ = Phase::down;
  int sender_ = -1;
  bool follows_ = false;
  const std::string* rule_ = nullptr;
  bool parallel_ = false;
};

/// What a rule is for: it applies where all that is given holds.
struct Guard {
  std::string type = "*";  ///< name of the elements' type; * stands for any letters
  std::optional<DeltaKind> kind = {};
  std::optional<Origin> origin = {};
  std::optional<Phase> phase = {};
  std::optional<bool> follows = {};
};

/// How a deformation is interpreted by elements of a type.
struct Rule {
  std::string name;
  Guard guard;
  std::function<void(RuleCall&)> apply;
  /// It only writes the elements of the batch, each from what it was and from its own symbol, and
  /// asks nobody: a large batch may be cut, its pieces done at once.
  bool parallel = false;
  std::string where = {};  ///< file and line of a script; empty: in C++
};

/// Rules, the first that applies is used; where none does, an element moves rigidly with the map
/// at its position and asks its children the same.
class RuleSet {
 public:
  void add(Rule rule) { rules_.push_back(std::move(rule)); }
  void add(const RuleSet& others) {
    rules_.insert(rules_.end(), others.rules_.begin(), others.rules_.end());
    bounds_.insert(bounds_.end(), others.bounds_.begin(), others.bounds_.end());
  }
  [[nodiscard]] const std::vector<Rule>& rules() const { return rules_; }
  template <class Condition>
  void remove_if(Condition condition) {
    std::erase_if(rules_, condition);
  }
  /// Types of elements with which a derivation turns from up to down, unless a rule absorbs it
  /// before; the root does always.
  void bound_locality(const std::string& type) { bounds_.push_back(type); }
  [[nodiscard]] bool bounds_locality(const std::string& type) const;
  /// A number for a derivation by these rules, or by copies of them.
  [[nodiscard]] std::uint64_t next_derivation() const { return ++*derivations_; }

 private:
  std::shared_ptr<std::atomic<std::uint64_t>> derivations_ =
      std::make_shared<std::atomic<std::uint64_t>>(0);
  std::vector<Rule> rules_;
  std::vector<std::string> bounds_;
};

/// Whether a text is of a pattern, in which * stands for any letters.
bool matches(const std::string& pattern, const std::string& text);

}  // namespace geoprior::grammar
