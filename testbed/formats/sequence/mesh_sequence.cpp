#include "testbed/formats/sequence/mesh_sequence.h"

#include <algorithm>

#include "core/error.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/mesh/vtp_reader.h"
#include "testbed/formats/sequence/repair.h"

namespace geoprior {

MeshFile read_frame_file(const FrameFile& frame) {
  if (frame.further.empty()) return read_mesh_file(frame.file);
  std::vector<MeshFile> parts;
  const auto add = [&](const std::filesystem::path& file) {
    parts.push_back(read_mesh_file(file));
    name_notes(parts.back(), file);
  };
  add(frame.file);
  for (const std::filesystem::path& file : frame.further) add(file);
  return joined(std::move(parts));
}

Eigen::MatrixX3d in_metres_z_up(const Eigen::MatrixX3d& rows, bool y_up, double scale) {
  Eigen::MatrixX3d out = scale * rows;
  if (y_up) {
    out.col(1) = -scale * rows.col(2);
    out.col(2) = scale * rows.col(1);
  }
  return out;
}

MeshSequence::MeshSequence(std::vector<FrameFile> files, bool y_up, double scale, std::string name)
    : files_(std::move(files)), y_up_(y_up), scale_(scale), name_(std::move(name)) {
  for (std::size_t i = 1; i < files_.size(); ++i) {
    if (files_[i].time > files_[i - 1].time) continue;
    throw Error("has the time " + std::to_string(files_[i].time) + " s after " +
                    std::to_string(files_[i - 1].time) + " s of " +
                    files_[i - 1].file.filename().string(),
                files_[i].file.string(), "times that increase strictly");
  }
}

const FrameFile& MeshSequence::file_at(int frame) const {
  if (frame < 0 || frame >= frame_count()) {
    throw Error("has no frame " + std::to_string(frame), name_,
                "0 to " + std::to_string(frame_count() - 1));
  }
  return files_[frame];
}

SurfaceFrame MeshSequence::frame(int frame) const {
  const FrameFile& file = file_at(frame);
  MeshFile read = read_frame_file(file);
  SurfaceFrame out;
  out.time = file.time;
  out.mesh.V = in_metres_z_up(read.mesh.V, y_up_, scale_);
  out.mesh.F = std::move(read.mesh.F);
  out.velocity = in_metres_z_up(read.velocity, y_up_, scale_);
  out.notes = std::move(read.notes);
  repair(out, file.file.string(), out.notes);
  return out;
}

}  // namespace geoprior
