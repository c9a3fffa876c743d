#include "baselines/grammar/instance_frames.h"

#include <vector>

#include "baselines/grammar/free_form.h"
#include "core/parallel.h"

namespace geoprior::grammar {
namespace {

constexpr std::size_t kFramesBlock = 256;

}  // namespace

Hierarchy instance_frames(const Hierarchy& before, const SpatialMap& map, int element) {
  Hierarchy after = before;
  const std::vector<char> moved = elements_below(before, element);
  const auto support = map.support();
  parallel_blocks(before.size(), kFramesBlock, [&](std::size_t begin, std::size_t end) {
    for (int e = static_cast<int>(begin); e < static_cast<int>(end); ++e) {
      if (moved[e] == 0 || !before.present(e)) continue;
      for (Eigen::Vector3d& x : after.points(e)) x = map.at(x);
      const Eigen::Vector3d& origin = before.position(e);
      if (support && !support->contains(origin)) continue;
      const MappedPoint there = map.with_jacobian(origin);
      after.set_pose(e, {there.position, rotation_of(there.jacobian) * before.turn(e)});
    }
  });
  return after;
}

}  // namespace geoprior::grammar
