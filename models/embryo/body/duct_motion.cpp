#include "models/embryo/body/duct_motion.h"

#include <utility>

#include "core/error.h"

namespace geoprior::embryo {

EndMotion::EndMotion(const std::vector<Key>& keys, Anchor Geometry::*which,
                     Interpolation interpolation)
    : interpolation_(interpolation) {
  const auto anchor = [&](std::size_t i) -> const Anchor& { return keys[i].geometry.*which; };
  for (std::size_t first = 0; first < keys.size();) {
    std::size_t end = first;
    std::vector<double> days;
    std::vector<Eigen::Vector3d> places;
    while (end < keys.size() && anchor(end).structure == anchor(first).structure) {
      days.push_back(keys[end].day);
      places.push_back(anchor(end).at);
      ++end;
    }
    Run run{anchor(first).structure, days.front(), days.back(), {}, {}};
    if (run.structure) {
      Eigen::MatrixXd values(std::ssize(places), 3);
      for (std::size_t i = 0; i < places.size(); ++i) values.row(i) = places[i].transpose();
      run.local = MonotoneCurve(std::move(days), std::move(values), interpolation, Ends::rest);
    } else {
      run.free = KeyPath(std::move(days), std::move(places), interpolation);
    }
    runs_.push_back(std::move(run));
    first = end;
  }
}

Eigen::Vector3d EndMotion::of_run(const Run& run, double day, const DuctSurroundings& body) {
  if (run.structure) return body.anchor(*run.structure, run.local.at(day));
  return body.frame + body.crown_rump_length * run.free.at(day);
}

std::size_t EndMotion::run_of(double day) const {
  std::size_t r = 0;
  while (r + 1 < runs_.size() && day >= runs_[r + 1].first) ++r;
  return r;
}

Anchor EndMotion::anchor(double day) const {
  const std::size_t r = run_of(day);
  const Run& run = runs_[r];
  if (r + 1 < runs_.size() && day > run.last) return {};
  return {run.structure, run.structure ? Eigen::Vector3d(run.local.at(day)) : run.free.at(day)};
}

Eigen::Vector3d EndMotion::at(double day, const DuctSurroundings& body) const {
  const std::size_t r = run_of(day);
  const Eigen::Vector3d here = of_run(runs_[r], day, body);
  if (r + 1 == runs_.size() || day <= runs_[r].last) return here;
  const double share = eased(day, runs_[r].last, runs_[r + 1].first, interpolation_);
  return here + share * (of_run(runs_[r + 1], day, body) - here);
}

std::vector<int> EndMotion::anchors() const {
  std::vector<int> out;
  for (const Run& run : runs_)
    if (run.structure) out.push_back(*run.structure);
  return out;
}

DuctMotion::DuctMotion(const std::vector<Key>& keys, const std::string& structure,
                       Interpolation interpolation)
    : start_(keys, &Geometry::start, interpolation), end_(keys, &Geometry::end, interpolation) {
  const std::size_t count = keys[0].geometry.via.size();
  for (const Key& key : keys) {
    if (key.geometry.via.size() != count)
      throw Error("it has " + std::to_string(key.geometry.via.size()) +
                      " control points between its ends at " + key.name + " and " +
                      std::to_string(count) + " at " + keys[0].name,
                  structure, "one number of them in all key frames");
  }
  for (std::size_t j = 0; j < count; ++j) {
    std::vector<double> days;
    std::vector<Eigen::Vector3d> places;
    for (const Key& key : keys) {
      days.push_back(key.day);
      places.push_back(key.geometry.via[j]);
    }
    via_.emplace_back(std::move(days), std::move(places), interpolation);
  }
}

std::vector<Eigen::Vector3d> DuctMotion::between(double day, const DuctSurroundings& body) const {
  std::vector<Eigen::Vector3d> points;
  for (const KeyPath& path : via_)
    points.push_back(body.frame + body.crown_rump_length * path.at(day));
  return points;
}

std::vector<int> DuctMotion::anchors() const {
  std::vector<int> out = start_.anchors();
  for (const int one : end_.anchors()) out.push_back(one);
  return out;
}

}  // namespace geoprior::embryo
