#include "experiments/embryo/measures/motion.h"

#include <algorithm>
#include <map>
#include <set>

#include "metrics/tracks/velocity_jump.h"
#include "metrics/volume/enclosed_volume.h"

namespace geoprior::embryo {
namespace {

/// A structure's recorded shape as rows of points: its centre, its sizes, the ends of its axes as
/// far out as it is large, and its centre line.
Eigen::MatrixXd points_of(const RecordedShape& one, const Part* lines) {
  std::vector<Eigen::Vector3d> rows{one.shape.center, one.shape.radii};
  for (int k = 0; k < 3; ++k) rows.emplace_back(one.shape.axes.col(k) * one.shape.radii.maxCoeff());
  if (lines != nullptr) {
    const NamedArray& codes =
        lines->require_array(recorded::kStructure, NamedArray::On::cells, 1, "centrelines");
    for (std::size_t l = 0; l < lines->lines.size(); ++l) {
      if (static_cast<int>(codes.values(static_cast<Eigen::Index>(l), 0)) != one.structure)
        continue;
      for (const int i : lines->lines[l]) rows.emplace_back(lines->points.row(i).transpose());
    }
  }
  Eigen::MatrixXd x(std::ssize(rows), 3);
  for (std::size_t i = 0; i < rows.size(); ++i)
    x.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  return x;
}

/// Motions of all structures. One that comes back, or whose line has other points, begins anew
/// under a further number.
std::vector<SampledMotion> motions_of(const FrameSequence& frames) {
  std::vector<SampledMotion> all;
  std::map<int, std::size_t> current;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto frame = frames.frame(i);
    std::map<int, std::size_t> next;
    for (const RecordedShape& one : recorded_shapes(*frame)) {
      Eigen::MatrixXd x = points_of(one, frame->find_part(recorded::kCentrelines));
      const auto before = current.find(one.structure);
      const bool goes_on =
          before != current.end() && all[before->second].x.back().rows() == x.rows();
      const std::size_t at = goes_on ? before->second : all.size();
      if (!goes_on) all.emplace_back();
      all[at].parameters.push_back(frame->parameter);
      all[at].x.push_back(std::move(x));
      next[one.structure] = at;
    }
    current = std::move(next);
  }
  return all;
}

std::optional<double> largest_jump(const EmbryoScene& scene,
                                   const std::vector<SampledMotion>& motions) {
  if (!scene.options.border_step) return std::nullopt;
  std::vector<double> middles;
  for (const Stage& stage : scene.ontology.stages) middles.push_back(stage.middle());
  std::optional<double> worst;
  for (const SampledMotion& motion : motions) {
    if (const auto jump = relative_velocity_jump(motion, middles, *scene.options.border_step))
      worst = std::max(worst.value_or(0), *jump);
  }
  return worst;
}

double reversals(const EmbryoScene& scene, const FrameSequence& frames) {
  constexpr double kRoundOff = 1e-3;  // of a mesh's volume against that of the shape
  std::set<int> reversed;
  std::map<int, double> before;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::map<int, double> now;
    for (const auto& [structure, mesh] : recorded_surfaces(*frames.frame(i))) {
      if (const auto volume = enclosed_volume(mesh)) now[structure] = *volume;
      const auto last = before.find(structure);
      if (last == before.end() || !now.contains(structure)) continue;
      if (scene.ontology.structures[structure].regresses) continue;
      if (now[structure] < last->second * (1 - kRoundOff)) reversed.insert(structure);
    }
    before = std::move(now);
  }
  return static_cast<double>(reversed.size());
}

std::optional<double> top_speed(const std::vector<SampledMotion>& motions) {
  std::optional<double> top;
  for (const SampledMotion& motion : motions) {
    for (std::size_t i = 1; i < motion.x.size(); ++i) {
      const double way = (motion.x[i].row(0) - motion.x[i - 1].row(0)).norm();
      top = std::max(top.value_or(0), way / (motion.parameters[i] - motion.parameters[i - 1]));
    }
  }
  return top;
}

}  // namespace

MotionMeasures motion_measures(const EmbryoScene& scene, const FrameSequence& frames) {
  const std::vector<SampledMotion> motions = motions_of(frames);
  return {largest_jump(scene, motions), reversals(scene, frames), top_speed(motions)};
}

}  // namespace geoprior::embryo
