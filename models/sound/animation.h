#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/sound/sheet.h"

namespace geoprior::sound {

/// A place that the tip of a tear has come to.
struct TornPlace {
  int tear = 0;                       ///< its number
  double time = 0;                    ///< s
  Eigen::Vector2d pattern{0, 0};      ///< m
  Eigen::Vector3d position{0, 0, 0};  ///< in space, of the left lip at the frame's time (m)
};

/// One frame of an animated sheet, whoever made it. Nothing but the pattern corresponds to the
/// frames beside it: the mesh may be another one.
struct SheetSnapshot {
  double time = 0;  ///< s
  ShellMesh mesh;
  Eigen::MatrixX3d x;           ///< one row a vertex (m)
  Eigen::MatrixX3d v;           ///< one row a vertex (m/s), or no rows: unknown
  std::vector<TornPlace> torn;  ///< every place of the tips until now, tear by tear
};

/// An animated sheet with coordinates of its pattern, read frame by frame.
class SheetAnimation {
 public:
  virtual ~SheetAnimation() = default;
  [[nodiscard]] virtual int frame_count() const = 0;
  /// Strictly increasing (s).
  [[nodiscard]] virtual double time(int frame) const = 0;
  /// @throws Error  naming file and place when the frame cannot be read
  [[nodiscard]] virtual SheetSnapshot snapshot(int frame) const = 0;
  /// What messages call it.
  [[nodiscard]] virtual std::string name() const = 0;
};

/// Frames that are in memory.
class StoredSheetAnimation final : public SheetAnimation {
 public:
  /// @throws Error  when times do not increase strictly
  StoredSheetAnimation(std::vector<SheetSnapshot> frames, std::string name);
  [[nodiscard]] int frame_count() const override { return static_cast<int>(frames_.size()); }
  [[nodiscard]] double time(int frame) const override { return frames_.at(frame).time; }
  [[nodiscard]] SheetSnapshot snapshot(int frame) const override { return frames_.at(frame); }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::vector<SheetSnapshot> frames_;
  std::string name_;
};

/// @throws Error  at `where`: no triangles, a vertex out of range, a coordinate that is not finite,
///                or a triangle that is turned over in the pattern or has no area there
void require_valid(const SheetSnapshot& frame, const std::string& where);

}  // namespace geoprior::sound
