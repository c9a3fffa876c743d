#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// An element as a frame has it.
struct RecordedElement {
  int number = 0;
  int type = 0;
  int parent = -1;  ///< -1: the root
  bool tagged = false;
  Pose pose;
  std::vector<double> parameters;
  std::vector<Eigen::Vector3d> keys;  ///< in the order of their numbers (m)
};

/// The elements of a frame, with their key points: what is measured of any method. Key points are
/// the frame's, which a method that knows no elements moved, parameters those of its elements.
class RecordedState {
 public:
  /// @param types  of the scene, by which numbers are read; they outlive the state
  /// @throws Error  when the frame has not the parts of models/grammar/record.h, an element is
  /// there
  ///                twice, a key point is of none, or a type is unknown
  RecordedState(const Frame& frame, const std::vector<ElementType>& types);
  /// What a frame of a hierarchy would have of these elements: those that are present.
  RecordedState(const Hierarchy& hierarchy, std::span<const int> elements);
  /// Of all that are present.
  explicit RecordedState(const Hierarchy& hierarchy);
  explicit RecordedState(Hierarchy&&) = delete;  // its types would not outlive the state

  /// Ascending by number.
  [[nodiscard]] const std::vector<RecordedElement>& elements() const { return elements_; }
  /// Null when there is none.
  [[nodiscard]] const RecordedElement* find(int number) const;
  /// The element of the same number, if it is of the same type and has as many key points: else
  /// null, for a number that a method gave another element.
  [[nodiscard]] const RecordedElement* find_same(const RecordedElement& element) const;
  [[nodiscard]] const std::string& type_name(const RecordedElement& element) const {
    return (*types_)[element.type].name;
  }
  /// Elements of a type, ascending.
  [[nodiscard]] std::vector<const RecordedElement*> of_type(const std::string& name) const;
  /// @throws Error  naming the type, when it has no such parameter
  [[nodiscard]] double parameter(const RecordedElement& element, const std::string& name) const {
    return element.parameters[(*types_)[element.type].parameter(name)];
  }
  /// Absent, when the type has none of that name.
  [[nodiscard]] std::optional<double> parameter_if_any(const RecordedElement& element,
                                                       const std::string& name) const;
  [[nodiscard]] const ElementType& type(const RecordedElement& element) const {
    return (*types_)[element.type];
  }
  [[nodiscard]] std::vector<int> numbers() const;

 private:
  void read_elements(const Frame& frame);
  void read_keys(const Frame& frame);
  void add(const Hierarchy& hierarchy, int element);

  const std::vector<ElementType>* types_;
  std::vector<RecordedElement> elements_;
};

/// Whether pose, parameters and key points are the same bytes.
bool same_bytes(const RecordedElement& a, const RecordedElement& b);
/// Whether parameters and key points are the same bytes: what is seen of it is.
bool looks_the_same(const RecordedElement& a, const RecordedElement& b);

}  // namespace geoprior::grammar
