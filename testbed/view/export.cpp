#include "testbed/view/export.h"

// Frames of a run as files of other tools, in the layout that the method "external" reads
// (testbed/external/frame_layout.h): out/<case>/<variant>/frames/<part>_0000.vtp, .obj or .ply with
// tables, events and artifacts beside them; or one animated out/<case>/<variant>/<part>.glb, whose
// nodes are structures where the part has any.

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/mesh.h"
#include "testbed/external/frame_layout.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/gltf/writer.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/process/stop.h"
#include "testbed/view/mesh_text.h"
#include "testbed/view/structure_export.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

const std::string kMarker = "geoprior-export.txt";
const std::vector<std::string> kFormats{"vtp", "obj", "ply", "glb"};

struct FrameFile {
  StoredFile file;
  std::string stem;  ///< "surface_0012"
  double parameter = 0;
};

/// Part name to its files, in order of frames.
std::map<std::string, std::vector<FrameFile>> files_by_part(const VariantRecord& variant) {
  std::map<std::string, std::vector<FrameFile>> parts;
  for (const FrameRecord& frame : variant.frames) {
    for (const StoredFile& stored : frame.files) {
      if (fs::path(stored.name).extension() == ".csv") continue;  // a table, open as it is
      const std::string stem = fs::path(stored.name).stem().string();
      parts[stem.substr(0, stem.find_last_of('_'))].push_back({stored, stem, frame.parameter});
    }
  }
  return parts;
}

/// Where an export goes: out/<case>/<variant>/, and a file that says whose it is.
///
/// A folder with anything in it that is not an earlier export is refused: its files would be mixed
/// with foreign ones or take their place. Nothing is made before the first file is asked for.
class ExportFolder {
 public:
  ExportFolder(fs::path out, std::string marker) : out_(std::move(out)), text_(std::move(marker)) {
    std::error_code ignored;
    if (fs::exists(out_, ignored) && !fs::is_directory(out_, ignored)) {
      throw Error("is a file", out_.string(), "a new or empty folder, or an earlier export");
    }
    if (fs::is_directory(out_, ignored) && !fs::is_empty(out_, ignored) &&
        !fs::exists(out_ / kMarker, ignored)) {
      throw Error("has files that no export made", out_.string(),
                  "a new or empty folder, or an earlier export");
    }
  }

  /// The folder of a variant, which is there from now on.
  fs::path folder_of(const CaseRecord& c, const VariantRecord& variant) {
    const fs::path folder = path_below(out_, fs::path(c.name) / variant.name);
    if (!marked_) {
      made_ = MadeFolders(out_);
      write_file_atomically(out_ / kMarker, std::string_view(text_));
      marked_ = true;
    }
    make_folders(folder);
    return folder;
  }

  /// A folder below it.
  fs::path room_of(const CaseRecord& c, const VariantRecord& variant, const char* room) {
    const fs::path folder = path_below(folder_of(c, variant), room);
    make_folders(folder);
    return folder;
  }

 private:
  fs::path out_;
  std::string text_;
  MadeFolders made_;
  bool marked_ = false;
};

std::string describe_frame(const CaseRecord& c, const VariantRecord& variant,
                           const FrameFile& frame) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%.10g", frame.parameter);
  return "geoprior: " + variant.name + ", " + c.parameter_name + " " + number.data() + " " +
         c.parameter_unit;
}

/// What stands beside the parts of the frames, and with `as_recorded` these in double precision
/// with all their arrays. Returns how many parts.
int export_layout(const OpenedRun& run, const CaseRecord& c, const VariantRecord& variant,
                  LayoutParts parts, ExportFolder& out) {
  int written = 0;
  write_layout(out.folder_of(c, variant), variant, parts, [&](const StoredFile& stored) {
    written += fs::path(stored.name).extension() == ".csv" ? 0 : 1;
    return bytes_of_file(run.file(stored));
  });
  return written;
}

/// Returns how many files were written.
int export_texts(const OpenedRun& run, const CaseRecord& c, const VariantRecord& variant,
                 const std::vector<FrameFile>& frames, const std::string& format,
                 ExportFolder& out) {
  int written = 0;
  for (const FrameFile& frame : frames) {
    throw_if_stopped();
    const Part part = run.part(frame.file);
    if (!is_mesh(part)) continue;
    const std::string comment = describe_frame(c, variant, frame);
    const std::string text =
        format == "obj" ? part_to_obj(part, comment) : part_to_ply(part, comment);
    write_file_atomically(out.room_of(c, variant, "frames") / (frame.stem + "." + format),
                          std::string_view(text));
    ++written;
  }
  return written;
}

bool same_topology(const std::vector<Part>& parts) {
  return std::all_of(parts.begin(), parts.end(), [&](const Part& part) {
    return part.points.rows() == parts.front().points.rows() &&
           same_triangles(part.triangles, parts.front().triangles);
  });
}

/// Seconds of the frames in the animation: a time as it is, a day an eighth of a second, any other
/// parameter spread evenly over 24 frames a second.
std::vector<double> animation_times(const CaseRecord& c, const std::vector<FrameFile>& frames) {
  constexpr double kFramesPerSecond = 24;
  constexpr double kSecondsADay = 0.125;
  const bool is_time = c.parameter_unit == "s", is_day = c.parameter_unit == "d";
  std::vector<double> times;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double since = frames[i].parameter - frames.front().parameter;
    times.push_back(is_time  ? since
                    : is_day ? kSecondsADay * since
                             : static_cast<double>(i) / kFramesPerSecond);
  }
  return times;
}

TriMesh mesh_of(const Part& part) { return {part.points, part.triangles}; }

/// One animation, or a still a frame where the topology changes and there are no structures.
int export_glb(const OpenedRun& run, const CaseRecord& c, const VariantRecord& variant,
               const std::string& part_name, const std::vector<FrameFile>& frames,
               ExportFolder& out) {
  std::vector<Part> parts;
  for (const FrameFile& frame : frames) {
    throw_if_stopped();
    parts.push_back(run.part(frame.file));
  }
  if (have_structures(parts)) {
    const std::string glb =
        structures_glb(parts, animation_times(c, frames), variant.name + " " + part_name);
    write_file_atomically(out.folder_of(c, variant) / (part_name + ".glb"), std::string_view(glb));
    return 1;
  }
  const bool triangles = std::all_of(parts.begin(), parts.end(), [](const Part& part) {
    return part.kind == Part::Kind::triangles && part.triangles.rows() > 0;
  });
  if (parts.empty() || !triangles) return 0;
  const fs::path folder = out.folder_of(c, variant);
  if (same_topology(parts)) {
    std::vector<Eigen::MatrixX3d> positions;
    for (const Part& part : parts) positions.push_back(part.points);
    write_glb_animation(folder / (part_name + ".glb"), mesh_of(parts.front()), positions,
                        animation_times(c, frames), variant.name + " " + part_name);
    return 1;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    throw_if_stopped();
    write_glb_animation(folder / (frames[i].stem + ".glb"), mesh_of(parts[i]), {}, {},
                        variant.name + " " + frames[i].stem);
  }
  return static_cast<int>(parts.size());
}

}  // namespace

void export_run(const OpenedRun& run, const std::string& format, const fs::path& out) {
  if (std::find(kFormats.begin(), kFormats.end(), format) == kFormats.end()) {
    throw Error("unknown format '" + format + "'", "export", "vtp, obj, ply, glb");
  }
  const RunRecord& record = run.record();
  ExportFolder folder(out,
                      "Frames of " + record.experiment_id + " as " + format +
                          ", written by geoprior export from run content " + record.content_sha256 +
                          ".\nA later export into this folder replaces files of the same name.\n");
  int written = 0;
  for (const CaseRecord& c : record.cases) {
    for (const VariantRecord& variant : c.variants) {
      int of_variant = 0;
      if (format == "vtp" && !variant.frames.empty()) {
        of_variant = export_layout(run, c, variant, LayoutParts::as_recorded, folder);
      }
      if (format != "vtp") {
        for (const auto& [name, frames] : files_by_part(variant)) {
          of_variant += format == "glb" ? export_glb(run, c, variant, name, frames, folder)
                                        : export_texts(run, c, variant, frames, format, folder);
        }
      }
      if (of_variant > 0 && (format == "obj" || format == "ply")) {
        export_layout(run, c, variant, LayoutParts::none, folder);
      }
      written += of_variant;
    }
  }
  if (written == 0) {
    throw Error("no part of its frames can be written as " + format, run.folder().string(),
                "grids stay .vti; glb holds triangles only");
  }
}

}  // namespace geoprior
