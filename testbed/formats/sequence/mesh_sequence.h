#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// One frame on disk.
struct FrameFile {
  std::filesystem::path file;
  int number = 0;                                   ///< in its name, or in the list of a .pvd
  double time = 0;                                  ///< s
  std::vector<std::filesystem::path> further = {};  ///< parts of the same frame
};

/// The mesh of a frame, its parts joined. @throws Error  as `read_mesh_file`
MeshFile read_frame_file(const FrameFile& frame);

/// Rows of coordinates or velocities of a file, in metres with z up.
/// @param y_up   the file has y up: (x, y, z) becomes (x, -z, y)
/// @param scale  metres a unit of the file
Eigen::MatrixX3d in_metres_z_up(const Eigen::MatrixX3d& rows, bool y_up, double scale);

/// Mesh files as an animated surface: every frame is read and repaired when it is asked for.
class MeshSequence final : public SurfaceSequence {
 public:
  /// @param y_up   the files have y up: (x, y, z) becomes (x, -z, y)
  /// @param scale  metres a unit of the files, velocities too
  /// @throws Error  when times do not increase strictly (names the files)
  MeshSequence(std::vector<FrameFile> files, bool y_up, double scale, std::string name);

  [[nodiscard]] int frame_count() const override { return static_cast<int>(files_.size()); }
  [[nodiscard]] double time(int frame) const override { return file_at(frame).time; }
  [[nodiscard]] SurfaceFrame frame(int frame) const override;
  [[nodiscard]] std::string name() const override { return name_; }
  /// @throws Error  when there is no such frame
  [[nodiscard]] const FrameFile& file_at(int frame) const;

 private:
  std::vector<FrameFile> files_;
  bool y_up_;
  double scale_;
  std::string name_;
};

}  // namespace geoprior
