#include "baselines/embryo/keyframes/keyframes.h"

#include <algorithm>
#include <string>
#include <utility>

#include "baselines/embryo/keyframes/primitive_mesh.h"
#include "core/error.h"

namespace geoprior::embryo {
namespace {

TriMesh keyframe_mesh(const DayState& state, const StructureState& one, int triangles) {
  const auto half = std::find_if(state.halves.begin(), state.halves.end(),
                                 [&](const Half& h) { return h.product == one.structure; });
  return half == state.halves.end() ? primitive_mesh(one.shape, triangles)
                                    : half_mesh(*half, triangles);
}

}  // namespace

Keyframes::Keyframes(std::span<const DayState> middles, std::span<const Stage> stages,
                     const KeyframesOptions& options) {
  if (middles.size() != stages.size() || stages.empty())
    throw Error(
        std::to_string(middles.size()) + " states of " + std::to_string(stages.size()) + " stages",
        "key frames", "as many of both, one or more");
  first_day_ = stages.front().start_day;
  last_day_ = stages.back().end_day;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double end = i + 1 < stages.size() ? stages[i + 1].start_day : last_day_;
    for (const StructureState& one : middles[i].structures) {
      TriMesh mesh = keyframe_mesh(middles[i], one, options.triangles);
      if (mesh.F.rows() == 0) continue;
      Track& track = tracks_[one.structure];
      if (track.days.empty()) track.first = stages[i].start_day;
      track.last = end;
      track.days.push_back(middles[i].day);
      track.V.push_back(std::move(mesh.V));
      track.F = std::move(mesh.F);
    }
  }
}

std::vector<KeyframedMesh> Keyframes::at(double day, const std::vector<bool>& hidden) const {
  if (!(day >= first_day_ && day <= last_day_))
    throw Error("there are no key frames of day " + std::to_string(day), "day",
                std::to_string(first_day_) + " to " + std::to_string(last_day_));
  std::vector<KeyframedMesh> meshes;
  for (const auto& [structure, track] : tracks_) {
    const bool last_of_all = day == last_day_ && track.last == last_day_;
    if (day < track.first || (day >= track.last && !last_of_all)) continue;
    if (structure < std::ssize(hidden) && hidden[structure]) continue;
    const auto above = std::upper_bound(track.days.begin(), track.days.end(), day);
    const std::size_t next = above - track.days.begin();
    KeyframedMesh out{structure, {track.V[next == 0 ? 0 : next - 1], track.F}};
    if (next > 0 && next < track.days.size()) {
      const double u = (day - track.days[next - 1]) / (track.days[next] - track.days[next - 1]);
      out.mesh.V += u * (track.V[next] - track.V[next - 1]);
    }
    meshes.push_back(std::move(out));
  }
  return meshes;
}

std::size_t Keyframes::bytes() const {
  std::size_t numbers = 0, corners = 0;
  for (const auto& [structure, track] : tracks_) {
    for (const Eigen::MatrixX3d& V : track.V) numbers += static_cast<std::size_t>(V.size());
    corners += static_cast<std::size_t>(track.F.size());
  }
  return numbers * sizeof(double) + corners * sizeof(int);
}

}  // namespace geoprior::embryo
