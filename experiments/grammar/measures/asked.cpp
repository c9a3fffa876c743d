#include "experiments/grammar/measures/asked.h"

#include <set>
#include <utility>

#include "experiments/grammar/scene/scene.h"

namespace geoprior::grammar {

AskedPlaces::AskedPlaces(const Hierarchy& rest, std::span<const Edit> edits,
                         std::shared_ptr<const SpatialMap> map, int from)
    : rest_(&rest), map_(std::move(map)), from_(from) {
  if (!edits.empty()) edited_ = rest;
  for (const Edit& edit : edits) apply(edit);
}

void AskedPlaces::apply(const Edit& edit) {
  Hierarchy& h = *edited_;
  const Delta& delta = edit.delta;
  switch (delta.kind) {
    case DeltaKind::set_parameter:
      h.set_parameter(edit.element, delta.parameter, delta.value);
      return;
    case DeltaKind::extrude:
      h.set_parameter(edit.element, delta.parameter,
                      h.parameter(edit.element, delta.parameter) + delta.value);
      return;
    case DeltaKind::translate:
    case DeltaKind::rigid:
      break;
    case DeltaKind::identity:
    case DeltaKind::children:
    case DeltaKind::free:
    case DeltaKind::affine:
      return;
  }
  const Eigen::Quaterniond turn(delta.transform.linear());
  for (int e = edit.element; e < h.size(); ++e) {
    if (!h.is_below(e, edit.element)) continue;
    h.set_pose(e, {delta.transform * h.position(e), turn * h.turn(e)});
    for (Eigen::Vector3d& x : h.points(e)) x = delta.transform * x;
  }
}

std::vector<Eigen::Vector3d> AskedPlaces::keys(int element) const {
  std::vector<Eigen::Vector3d> out;
  before_map().keys(element, out);
  if (!map_ || !before_map().is_below(element, from_)) return out;
  for (Eigen::Vector3d& x : out) x = map_->at(x);
  return out;
}

AskedPlaces asked_at(const GrammarScene& scene, std::size_t step) {
  std::vector<Edit> edits;
  for (std::size_t i = 0; i <= step; ++i)
    if (scene.steps.at(i).kind == Step::Kind::edit)
      edits.push_back(scene.edits.at(scene.steps[i].number).wish);
  return {scene.rest, edits, scene.asked_map(step), scene.gesture_element};
}

std::vector<int> out_of_reach(const RecordedState& state, const SpatialMap& map) {
  std::vector<int> out;
  if (!map.support()) return out;
  Eigen::AlignedBox3d all;
  for (const RecordedElement& e : state.elements())
    for (const Eigen::Vector3d& x : e.keys) all.extend(x);
  const double margin = kReachMargin * all.diagonal().norm();
  // A parent has a lower number than its children; the root holds them only together.
  std::set<int> reached;
  for (const RecordedElement& e : state.elements()) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& x : e.keys) {
      box.extend(Eigen::Vector3d(x.array() - margin));
      box.extend(Eigen::Vector3d(x.array() + margin));
    }
    if (e.parent < 0) continue;
    if (reached.contains(e.parent) || (!e.keys.empty() && reaches(map, box)))
      reached.insert(e.number);
    else
      out.push_back(e.number);
  }
  return out;
}

}  // namespace geoprior::grammar
