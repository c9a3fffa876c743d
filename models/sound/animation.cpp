#include "models/sound/animation.h"

#include <utility>

#include "core/error.h"

namespace geoprior::sound {
namespace {

void require_finite(const Eigen::MatrixXd& rows, const char* what, const std::string& where) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (rows.row(i).allFinite()) continue;
    throw Error(std::string(what) + " of vertex " + std::to_string(i) + " is not finite", where,
                "finite numbers");
  }
}

}  // namespace

StoredSheetAnimation::StoredSheetAnimation(std::vector<SheetSnapshot> frames, std::string name)
    : frames_(std::move(frames)), name_(std::move(name)) {
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    if (frames_[i].time > frames_[i - 1].time) continue;
    throw Error("frame " + std::to_string(i) + " has the time " + std::to_string(frames_[i].time) +
                    " s after " + std::to_string(frames_[i - 1].time) + " s",
                name_, "times that increase strictly");
  }
}

void require_valid(const SheetSnapshot& frame, const std::string& where) {
  const ShellMesh& mesh = frame.mesh;
  if (mesh.triangle_count() == 0) throw Error("has no triangles", where);
  if (frame.x.rows() != mesh.vertex_count()) {
    throw Error("has " + std::to_string(frame.x.rows()) + " places", where,
                std::to_string(mesh.vertex_count()) + ", one a point of the pattern");
  }
  require_finite(mesh.pattern, "pattern coordinate", where);
  require_finite(frame.x, "place", where);
  require_finite(frame.v, "velocity", where);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(t, k);
      if (v >= 0 && v < mesh.vertex_count()) continue;
      throw Error("triangle " + std::to_string(t) + " has the vertex " + std::to_string(v), where,
                  "0 to " + std::to_string(mesh.vertex_count() - 1));
    }
    if (pattern_area(mesh, t) > 0) continue;
    throw Error("triangle " + std::to_string(t) + " has no area in the pattern or is turned over",
                where, "counter-clockwise triangles");
  }
}

}  // namespace geoprior::sound
