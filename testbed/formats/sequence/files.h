#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "core/options.h"
#include "testbed/formats/sequence/mesh_sequence.h"

namespace geoprior {

/// Which axis of the files points up. `from_sidecar`: what the sidecar says, else z.
enum class UpAxis { from_sidecar, z, y };

/// An animated surface on disk. What a sidecar `<path>.json` says ({"frames_per_second": 24, "up":
/// "y", "scale": 0.01, "start": 0}, every key optional) holds where the option is absent.
struct SequenceOptions {
  /// Numbered files "splash_%04d.ply", a folder with one such sequence (the frames of a run), a
  /// .pvd, a .vtp.series, or one mesh file: a still.
  std::string path;
  std::string part = "surface";
  UpAxis up = UpAxis::from_sidecar;
  std::optional<double> scale;
  /// Default: sidecar, else the times of the files (.pvd, TimeValue), else 25 with a warning.
  std::optional<double> frames_per_second;
  std::optional<double> start;     ///< time of the first frame (s); default: sidecar, the files', 0
  std::optional<int> first, last;  ///< numbers of the frames to take; of a .pvd counted from 0
};
void describe(OptionVisitor& v, SequenceOptions& options);

/// The files of a sequence with their times, and how what is in them becomes metres with z up.
struct SequenceFiles {
  std::vector<FrameFile> files;  ///< one or more
  bool y_up = false;             ///< (x, y, z) becomes (x, -z, y)
  double scale = 1;              ///< metres a unit of the files
};

/// Finds them, unread; arguments and errors as those of `open_sequence`.
SequenceFiles find_sequence(const SequenceOptions& options, const std::filesystem::path& folder,
                            std::vector<std::string>& warnings,
                            std::vector<std::filesystem::path>& inputs);

/// Opens a sequence. Frames are read when asked for (safely from several threads), in metres with z
/// up; polygons are cut into triangles, doubled vertices along seams welded. Topology may change
/// from frame to frame.
///
/// Files are looked for relative to `folder`, then to the working folder. The first, the middle and
/// the last frame are read here, so that most mistakes come up at once. Frames without a triangle
/// at the beginning are left out, with a warning; times stay.
///
/// @param warnings  added: missing frames, uneven times, a frame rate that nothing says, meshes
///                  turned over because they were inside out, welded or dropped vertices
/// @param inputs    added: every file the sequence may read
/// @throws Error    naming file and line or byte: nothing matches, unknown extension, an
/// unreadable,
///                  truncated or empty file, NaN, a non-manifold edge (named), times that repeat.
///                  `frame(i)` throws the same, and for an index out of range.
std::shared_ptr<SurfaceSequence> open_sequence(const SequenceOptions& options,
                                               const std::filesystem::path& folder,
                                               std::vector<std::string>& warnings,
                                               std::vector<std::filesystem::path>& inputs);

}  // namespace geoprior
