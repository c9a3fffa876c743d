#include "solvers/grammar/engine/transaction.h"

#include <algorithm>
#include <utility>

namespace geoprior::grammar {

Transaction::Transaction(Hierarchy& hierarchy) : hierarchy_(hierarchy) { restart(); }

void Transaction::restart() {
  for (const int element : elements_) slot_[element] = -1;
  elements_.clear();
  poses_.clear();
  present_.clear();
  first_value_.clear();
  values_.clear();
  points_.clear();
  points_slot_.clear();
  first_new_ = hierarchy_.size();
  slot_.resize(first_new_, -1);
  ++derivation_;
}

bool Transaction::visit(int element, Phase phase) {
  auto& last = phase == Phase::up ? up_ : down_;
  if (element >= static_cast<int>(last.size())) last.resize(hierarchy_.size(), 0);
  return std::exchange(last[element], derivation_) != derivation_;
}

void Transaction::own(int element, std::uint32_t batch) {
  if (element >= static_cast<int>(owner_.size())) owner_.resize(hierarchy_.size(), 0);
  owner_[element] = batch;
}

void Transaction::touch(std::span<const int> elements) {
  for (const int element : elements) {
    if (touched(element)) continue;
    slot_[element] = static_cast<int>(elements_.size());
    elements_.push_back(element);
    poses_.push_back(hierarchy_.pose(element));
    present_.push_back(hierarchy_.present(element) ? 1 : 0);
    first_value_.push_back(values_.size());
    const auto own = hierarchy_.parameters(element);
    values_.insert(values_.end(), own.begin(), own.end());
    const auto points = std::as_const(hierarchy_).points(element);
    points_slot_.push_back(points.empty() ? -1 : static_cast<int>(points_.size()));
    if (!points.empty()) points_.emplace_back(points.begin(), points.end());
  }
}

Pose Transaction::pose_before(int element) const {
  const int slot = slot_of(element);
  return slot < 0 ? hierarchy_.pose(element) : poses_[slot];
}

double Transaction::parameter_before(int element, int number) const {
  const int slot = slot_of(element);
  return slot < 0 ? hierarchy_.parameter(element, number) : values_[first_value_[slot] + number];
}

std::span<const Eigen::Vector3d> Transaction::points_before(int element) const {
  const int slot = slot_of(element);
  if (slot < 0) return std::as_const(hierarchy_).points(element);
  if (points_slot_[slot] < 0) return {};
  return points_[points_slot_[slot]];
}

std::vector<int> Transaction::changed() const {
  std::vector<int> out;
  for (std::size_t slot = 0; slot < elements_.size(); ++slot) {
    const int e = elements_[slot];
    const auto own = hierarchy_.parameters(e);
    const auto points = points_before(e);
    const auto points_now = std::as_const(hierarchy_).points(e);
    const bool same = poses_[slot].position == hierarchy_.position(e) &&
                      poses_[slot].turn.coeffs() == hierarchy_.turn(e).coeffs() &&
                      (present_[slot] != 0) == hierarchy_.present(e) &&
                      std::equal(own.begin(), own.end(), values_.begin() + first_value_[slot]) &&
                      std::equal(points.begin(), points.end(), points_now.begin());
    if (!same) out.push_back(e);
  }
  return out;
}

void Transaction::roll_back() {
  hierarchy_.truncate(first_new_);
  for (std::size_t slot = 0; slot < elements_.size(); ++slot) {
    const int element = elements_[slot];
    hierarchy_.set_pose(element, poses_[slot]);
    hierarchy_.set_present(element, present_[slot] != 0);
    const auto count = hierarchy_.type(element).parameters.size();
    for (std::size_t p = 0; p < count; ++p)
      hierarchy_.set_parameter(element, static_cast<int>(p), values_[first_value_[slot] + p]);
    if (points_slot_[slot] < 0) continue;
    const auto& saved = points_[points_slot_[slot]];
    std::copy(saved.begin(), saved.end(), hierarchy_.points(element).begin());
  }
  restart();
}

}  // namespace geoprior::grammar
