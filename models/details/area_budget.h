#pragma once

#include <vector>

#include "models/details/mesh.h"

namespace geoprior::details {

/// How many details each patch of the surface should have now: as many as at rest, times the factor
/// by which its area has grown.
///
/// Patches are groups of faces around evenly chosen details; target(P) = n0(P) A(P) / A0(P), so the
/// density of details stays what it was, a motion that returns asks for what there was, and a
/// surface at rest asks for nothing. Which faces make a patch never changes. Faces far
/// from any detail at rest (one and a half times the spacing there, or the mean edge if that is
/// more) are bare: they belong to no patch (-1), ask for nothing and take nothing.
class AreaBudget {
 public:
  AreaBudget() = default;
  /// Patches of about `details_per_patch` details of `original`, at rest.
  AreaBudget(const DetailMesh& original, int details_per_patch);

  /// Frames ahead for which patches ask while they grow, and while they shrink.
  struct Lead {
    double growing = 0, shrinking = 0;
  };
  /// Measures the areas. Targets are those of some frames ahead, by the change of the area since
  /// the last call.
  void update(const DetailMesh& details, const Lead& lead);
  void update(const DetailMesh& details) { update(details, {}); }
  /// Counts the details whose target weight is not 0; `add` keeps the count from then on.
  void count(const DetailMesh& details);
  [[nodiscard]] int patch_count() const { return static_cast<int>(rest_area_.size()); }
  [[nodiscard]] int patch_of(const SurfacePoint& at) const { return patch_[at.face]; }
  /// The pattern covers a part of the surface: more than a hundredth of it is in no patch (gaps of
  /// a pattern that covers all are less).
  [[nodiscard]] bool leaves_bare() const { return leaves_bare_; }
  /// Details that the patch lacks (negative: has too many); 0 for patch -1.
  [[nodiscard]] double deficit(int patch) const;
  /// Counts a detail that came (+1) or goes (-1).
  void add(int patch, int change);
  [[nodiscard]] double total_target() const;
  /// Areas of the last update: all that the next one depends on.
  void save(StateWriter& out) const { out.items(area_); }
  void load(StateReader& in) { in.items(area_); }

 private:
  static constexpr double kBareAfter = 1.5;
  static constexpr double kBareShare = 0.01;
  void leave_bare_faces(const DetailMesh& original);

  bool leaves_bare_ = false;
  std::vector<int> patch_;              ///< per face
  std::vector<int> face_begin_, face_;  ///< faces of a patch
  std::vector<double> rest_area_, rest_count_, area_, target_, count_;
};

}  // namespace geoprior::details
