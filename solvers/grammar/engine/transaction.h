#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"
#include "solvers/grammar/engine/symbol.h"

namespace geoprior::grammar {

/// What elements were before a derivation touched them: enough to take it back, and the exact list
/// of what it touched. Its cost grows with what is touched, not with the hierarchy, but for a
/// table of one number an element that is made once and used again.
class Transaction {
 public:
  explicit Transaction(Hierarchy& hierarchy);

  /// Remembers the elements' poses, parameters, points and presence, the first time; to be called
  /// before they are written.
  void touch(std::span<const int> elements);
  [[nodiscard]] bool touched(int element) const {
    return element >= first_new_ || slot_[element] >= 0;
  }
  /// Elements that were there before and were remembered, in the order of `touch`.
  [[nodiscard]] const std::vector<int>& touched() const { return elements_; }
  /// From this number on elements are new.
  [[nodiscard]] int first_new() const { return first_new_; }

  /// Elements of `touched` that are not, bit for bit, what they were.
  [[nodiscard]] std::vector<int> changed() const;

  /// Notes that an element is asked in a phase: false when it was already.
  bool visit(int element, Phase phase);
  /// Whose turn it is to write an element: a number that the derivation gives its batches.
  void own(int element, std::uint32_t batch);
  std::uint32_t next_batch() { return ++batches_; }
  [[nodiscard]] bool owns(int element, std::uint32_t batch) const {
    return element < static_cast<int>(owner_.size()) && owner_[element] == batch;
  }

  /// What an element was before; of one that was not touched, or is new, what it is.
  [[nodiscard]] Pose pose_before(int element) const;
  [[nodiscard]] double parameter_before(int element, int number) const;
  [[nodiscard]] std::span<const Eigen::Vector3d> points_before(int element) const;

  /// Puts everything back as it was, bit for bit. Nothing is remembered then.
  void roll_back();
  /// Begins anew at the present state.
  void restart();

 private:
  [[nodiscard]] int slot_of(int element) const {
    return element >= first_new_ ? -1 : slot_[element];
  }

  Hierarchy& hierarchy_;
  int first_new_ = 0;
  std::vector<int> slot_;  ///< of an element in the arrays below; -1: not touched
  std::vector<int> elements_;
  std::vector<Pose> poses_;
  std::vector<char> present_;
  std::vector<std::size_t> first_value_;
  std::vector<double> values_;
  std::vector<std::vector<Eigen::Vector3d>> points_;  ///< of the slots that have some, by number
  std::vector<int> points_slot_;
  std::vector<std::uint32_t> up_, down_;  ///< number of the derivation that asked last
  std::vector<std::uint32_t> owner_;
  std::uint32_t derivation_ = 0;
  std::uint32_t batches_ = 0;
};

}  // namespace geoprior::grammar
