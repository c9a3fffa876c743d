#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// One frame of an animated surface. Nothing corresponds to the frames beside it: vertices,
/// triangles and components may all be others.
struct SurfaceFrame {
  double time = 0;  ///< s
  TriMesh mesh;
  Eigen::MatrixX3d velocity;       ///< one row per vertex (m/s), or no rows: unknown
  std::vector<std::string> notes;  ///< what was repaired when it was read
};

/// An animated surface, read frame by frame: a sequence need not fit into memory.
class SurfaceSequence {
 public:
  virtual ~SurfaceSequence() = default;
  [[nodiscard]] virtual int frame_count() const = 0;
  /// Strictly increasing (s).
  [[nodiscard]] virtual double time(int frame) const = 0;
  /// @throws Error  naming file and place when the frame cannot be read
  [[nodiscard]] virtual SurfaceFrame frame(int frame) const = 0;
  /// What messages call it: a file name pattern, a run.
  [[nodiscard]] virtual std::string name() const = 0;

  /// Shortest interval between two frames (s); 0 for a single frame.
  [[nodiscard]] double frame_interval() const;
  /// Number of the frame whose time is nearest; the earlier one of two.
  [[nodiscard]] int nearest_frame(double time) const;
};

/// Frames that are in memory: tests, short clips, a still mesh (one frame).
class StoredSequence final : public SurfaceSequence {
 public:
  /// @throws Error  when times do not increase strictly
  StoredSequence(std::vector<SurfaceFrame> frames, std::string name);
  [[nodiscard]] int frame_count() const override { return static_cast<int>(frames_.size()); }
  [[nodiscard]] double time(int frame) const override;
  [[nodiscard]] SurfaceFrame frame(int frame) const override;
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::vector<SurfaceFrame> frames_;
  std::string name_;
};

}  // namespace geoprior
