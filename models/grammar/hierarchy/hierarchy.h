#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "models/grammar/hierarchy/element_type.h"

namespace geoprior::grammar {

/// Where an element is: its frame in the world (m).
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& x) const {
    return position + turn * x;
  }
};

/// What the user did to an element, which nothing above it may undo.
struct Tag {
  enum class Follow {
    rigid,  ///< it moves with what it hangs on, as one rigid body with all below it
    stop    ///< it and all below it stay where they are
  };
  int edit = 0;  ///< number of the edit that left it
  Follow follow = Follow::rigid;
};

/// Elements, each with a type, a parent, a pose, parameters and perhaps points; element 0 is the
/// root. A value: copies are independent.
///
/// Elements keep their numbers: one that is removed stays in the arrays and is not `present`, one
/// that is added comes last. Storage is by array, so that a million elements are a few blocks.
class Hierarchy {
 public:
  explicit Hierarchy(std::vector<ElementType> types = {});

  /// The number of a new type.
  int add_type(ElementType type);
  /// Appends an element; the first one is the root and has the parent -1.
  /// @param parameters  as many as the type has; not checked against their ranges
  /// @param points      of its own (m), may be empty
  /// @throws Error  naming the type: another number of parameters, no such parent or type
  int add(int type, int parent, const Pose& pose, std::span<const double> parameters = {},
          std::span<const Eigen::Vector3d> points = {});
  /// Room for so many elements and parameters.
  void reserve(std::size_t elements, std::size_t parameters);

  [[nodiscard]] int size() const { return static_cast<int>(type_.size()); }
  [[nodiscard]] int present_count() const { return present_count_; }
  [[nodiscard]] const std::vector<ElementType>& types() const { return types_; }
  [[nodiscard]] const ElementType& type(int element) const { return types_[type_[element]]; }
  [[nodiscard]] int type_number(int element) const { return type_[element]; }
  /// -1 when there is none of that name.
  [[nodiscard]] int find_type(const std::string& name) const;
  [[nodiscard]] int parent(int element) const { return parent_[element]; }  ///< -1: the root
  /// In the order in which they were added; those that are not present are among them.
  [[nodiscard]] const std::vector<int>& children(int element) const { return children_[element]; }
  [[nodiscard]] bool present(int element) const { return present_[element] != 0; }

  [[nodiscard]] const Eigen::Vector3d& position(int element) const { return position_[element]; }
  [[nodiscard]] const Eigen::Quaterniond& turn(int element) const { return turn_[element]; }
  [[nodiscard]] Pose pose(int element) const { return {position_[element], turn_[element]}; }
  [[nodiscard]] std::span<const double> parameters(int element) const {
    return {values_.data() + first_value_[element], value_count(element)};
  }
  [[nodiscard]] double parameter(int element, int number) const {
    return values_[first_value_[element] + number];
  }
  /// Its own points in the world (m).
  [[nodiscard]] std::span<const Eigen::Vector3d> points(int element) const;

  void set_position(int element, const Eigen::Vector3d& x) { position_[element] = x; }
  void set_pose(int element, const Pose& pose) {
    position_[element] = pose.position;
    turn_[element] = pose.turn;
  }
  void set_parameter(int element, int number, double value) {
    values_[first_value_[element] + number] = value;
  }
  [[nodiscard]] std::span<Eigen::Vector3d> points(int element);
  /// Without what is below it.
  void set_present(int element, bool present);
  /// Takes back the elements that were added last, so that `size` are left.
  void truncate(int size);

  /// A name that a user may give an element; absent for most.
  void set_name(int element, std::string name) { names_[element] = std::move(name); }
  /// The name, or "branch-17" for the seventeenth element of its type, counted from 1 in order of
  /// numbers.
  [[nodiscard]] std::string label(int element) const;
  /// The element of that label. @throws Error  naming `where`, when there is none
  [[nodiscard]] int find(const std::string& label, const std::string& where) const;

  void set_tag(int element, const Tag& tag) { tags_[element] = tag; }
  /// Null for most.
  [[nodiscard]] const Tag* tag(int element) const {
    if (tags_.empty()) return nullptr;
    const auto found = tags_.find(element);
    return found == tags_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const std::map<int, Tag>& tags() const { return tags_; }

  /// Appends the element's key points in the world (m): its own points, or those of its type.
  void keys(int element, std::vector<Eigen::Vector3d>& out) const;

  /// Whether `element` is `ancestor` or below it.
  [[nodiscard]] bool is_below(int element, int ancestor) const;

  /// @throws Error  naming the element: a parent that comes after it (which a hierarchy without
  ///                cycles, built by `add`, has not), a parameter out of its type's range, a number
  ///                that is not finite
  void require_valid() const;

 private:
  [[nodiscard]] std::size_t value_count(int element) const {
    return types_[type_[element]].parameters.size();
  }

  std::vector<ElementType> types_;
  std::vector<int> type_, parent_;
  std::vector<std::vector<int>> children_;
  std::vector<char> present_;
  std::vector<Eigen::Vector3d> position_;
  std::vector<Eigen::Quaterniond> turn_;
  std::vector<std::size_t> first_value_;
  std::vector<double> values_;
  std::map<int, std::vector<Eigen::Vector3d>> points_;  ///< of the few elements that have some
  std::map<int, std::string> names_;
  std::map<int, Tag> tags_;
  int present_count_ = 0;
};

}  // namespace geoprior::grammar
