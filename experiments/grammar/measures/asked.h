#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "experiments/grammar/measures/recorded_state.h"
#include "models/grammar/maps/spatial_map.h"
#include "solvers/grammar/engine/derivation.h"

namespace geoprior::grammar {

class GrammarScene;

/// What a user asks of an object, before anybody interprets it: edits one after the other, each of
/// the edited element and what is below it, then a deformation of space.
///
/// An edit that moves (rigid, translate) moves all key points of the elements below; one that sets
/// a parameter gives the edited element the key points of its type with that parameter; one that
/// asks for children asks no key point to move.
class AskedPlaces {
 public:
  /// @param rest  outlives this
  /// @param map   null: none
  /// @param from  the element of which, and of what is below, space is deformed
  AskedPlaces(const Hierarchy& rest, std::span<const Edit> edits,
              std::shared_ptr<const SpatialMap> map, int from);

  /// Whether an element is of the rest, be it present there or not.
  [[nodiscard]] bool knows(const RecordedElement& element) const {
    return element.number < rest_->size() && rest_->type_number(element.number) == element.type;
  }
  /// Where the key points of an element of the rest are asked to be.
  [[nodiscard]] std::vector<Eigen::Vector3d> keys(int element) const;
  /// Where a place of the object at rest is asked to be, by the deformation of space alone.
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const {
    return map_ ? map_->at(x) : x;
  }

 private:
  void apply(const Edit& edit);
  [[nodiscard]] const Hierarchy& before_map() const { return edited_ ? *edited_ : *rest_; }

  const Hierarchy* rest_;
  std::optional<Hierarchy> edited_;
  std::shared_ptr<const SpatialMap> map_;
  int from_;
};

/// What the user of a scene has asked for by the end of a step.
/// @param scene  outlives the places
AskedPlaces asked_at(const GrammarScene& scene, std::size_t step);

/// How far from a deformation something is that has nothing to do with it, over the diagonal of the
/// object: neighbours of what is moved may have to make room.
inline constexpr double kReachMargin = 0.1;

/// Elements of a state, without the root, that a deformation of space does not reach: the box of
/// the key points of the element, grown by the margin, and of each above it but the root, has no
/// point in common with the box outside of which the map is the identity. Empty where the map has
/// no such box.
std::vector<int> out_of_reach(const RecordedState& state, const SpatialMap& map);

}  // namespace geoprior::grammar
