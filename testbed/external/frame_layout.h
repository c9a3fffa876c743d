#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/external/options.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/topic.h"

namespace geoprior {

/// Frames on the disk as `geoprior export` writes and the method "external" reads them, found but
/// unread (docs/external-methods.md):
///
///     frames.csv                       columns frame (0, 1, …) and parameter
///     frames/<part>_0000.vtp           .vti, .ply, .obj, .glb: one file a part and frame
///     frames/<table>_0000.csv          tables of the frame
///     diagnostics.csv, events.csv      a row a frame, a row an event
///     artifacts/<name>                 files that are no frames
struct ExternalFrames {
  struct Piece {
    std::string name;  ///< of the part or table
    std::filesystem::path file;
  };
  struct Entry {
    std::optional<double> parameter;  ///< absent: that of its files
    std::vector<Piece> pieces;
    std::map<std::string, double> diagnostics;
  };
  std::filesystem::path root;  ///< for messages
  std::vector<Entry> frames;
  std::vector<Event> events;
  std::vector<Piece> artifacts;
};

/// Finds what `options.frames` means.
/// @param base  folder against which it is taken
/// @param default_part  that numbered files are where the options do not say
/// @throws Error  naming file and place: nothing there, gaps or doubles, names that are none,
///                another number of frames or other parameters than the scene has
ExternalFrames find_external_frames(const ExternalOptions& options,
                                    const std::filesystem::path& base,
                                    const std::string& default_part, const Scene& scene);

/// The files that `find_external_frames` would look at, whatever they hold; none where nothing is.
std::vector<std::filesystem::path> files_of_external_frames(const ExternalOptions& options,
                                                            const std::filesystem::path& base);

/// Reads one frame. @throws Error  naming the file: unreadable, not finite, or of a time that is
/// not the frame's
Frame read_external_frame(const ExternalFrames::Entry& entry);

/// Puts the vertices of a frame's part in the order of the scene, and gives triangles to a part
/// that came without.
/// @param vertex  for each vertex of the scene the one of the frame; empty: the same
/// @throws Error  naming part and numbers: it is not there, of another kind, has other counts or
///                triangles
void fit_to_shape(Frame& frame, const PartShape& shape, const std::vector<int>& vertex,
                  const std::string& where);

/// Column "vertex" of a correspondence. @throws Error  naming file and line
std::vector<int> read_correspondence(const std::filesystem::path& file);

/// Which files of the frames are written: tables alone, where the parts take another form.
enum class LayoutParts { as_recorded, none };

/// Writes what was recorded of a variant into a folder of the layout.
/// @param bytes_of  of a recorded file
/// @throws Error    naming the file that cannot be written, and what `bytes_of` throws
void write_layout(const std::filesystem::path& folder, const VariantRecord& variant,
                  LayoutParts parts,
                  const std::function<std::vector<std::byte>(const StoredFile&)>& bytes_of);

}  // namespace geoprior
