#include "testbed/formats/sequence/files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "core/error.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/sequence/find.h"
#include "testbed/formats/sequence/mesh_sequence.h"
#include "testbed/formats/sequence/sidecar.h"
#include "testbed/formats/sequence/times.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

/// Relative to the experiment's folder when it is there, else to the working folder.
fs::path located(const std::string& path, const fs::path& folder) {
  const fs::path given(path);
  if (given.is_absolute()) return given;
  const fs::path beside = folder / given;
  if (path.find('%') != std::string::npos) {
    return matches_any(beside) || !matches_any(given) ? beside : given;
  }
  return fs::exists(beside) || !fs::exists(given) ? beside : given;
}

FoundFiles find_files(const fs::path& path, const std::string& part) {
  if (path.string().find('%') != std::string::npos) return find_pattern(path);
  if (fs::is_directory(path)) return find_in_folder(path, part);
  if (!fs::is_regular_file(path)) {
    throw Error("is no file or folder", path.string(),
                "name_%04d with " + mesh_file_extensions() + ", a folder, .pvd, .series, a mesh");
  }
  if (path.extension() == ".pvd" || path.extension() == ".series")
    return find_in_collection(path, part);
  if (!is_mesh_file_extension(path.extension().string())) {
    throw Error("has the extension '" + path.extension().string() + "'", path.string(),
                mesh_file_extensions() + ", .pvd, .series");
  }
  FoundFiles found;
  found.files.push_back({path, 0, {}});
  return found;
}

void select(FoundFiles& found, const SequenceOptions& options, const std::string& name) {
  const int from = found.files.front().number, to = found.files.back().number;
  std::erase_if(found.files, [&](const FoundFile& file) {
    return file.number < options.first.value_or(from) || file.number > options.last.value_or(to);
  });
  if (!found.files.empty()) return;
  throw Error("has no frame between first and last", name,
              "frames " + std::to_string(from) + " to " + std::to_string(to));
}

/// Reads the first, the middle and the last frame: what is wrong with one is mostly wrong with all.
/// What was repaired is told once, by the first that had it.
void probe(const MeshSequence& sequence, std::vector<std::string>& warnings) {
  const int last = sequence.frame_count() - 1;
  std::set<std::string> told;
  int before = -1;
  for (const int i : {0, last / 2, last}) {
    if (i == before) continue;
    before = i;
    for (const std::string& note : sequence.frame(i).notes) {
      if (!told.insert(note).second) continue;
      warnings.push_back(sequence.file_at(i).file.filename().string() + ": " + note +
                         (last > 0 ? " (further frames are not named)" : ""));
    }
  }
}

/// Takes away the frames at the beginning that have no triangle: nothing has flowed in yet.
void drop_empty_beginning(std::vector<FrameFile>& files, const std::string& name,
                          std::vector<std::string>& warnings) {
  if (files.size() < 2) return;
  std::size_t empty = 0;
  while (empty < files.size() && read_frame_file(files[empty]).mesh.F.rows() == 0) ++empty;
  if (empty == 0) return;
  if (empty == files.size()) throw Error("has no triangle in any frame", name);
  const std::string last = empty == 1 ? "" : " to " + files[empty - 1].file.filename().string();
  warnings.push_back(files.front().file.filename().string() + last +
                     " without a triangle: no surface yet; the sequence begins with " +
                     files[empty].file.filename().string() + ", at " +
                     std::to_string(files[empty].time) + " s");
  files.erase(files.begin(), files.begin() + empty);
}

/// Every file that is read for a frame.
void add_files(const FoundFile& frame, std::vector<fs::path>& inputs) {
  const auto add = [&](const fs::path& file) {
    for (const fs::path& piece : files_of_mesh(file)) inputs.push_back(piece);
  };
  add(frame.file);
  for (const fs::path& file : frame.further) add(file);
}

}  // namespace

void describe(OptionVisitor& v, SequenceOptions& o) {
  static constexpr std::array<std::string_view, 3> kUp{"from-sidecar", "z", "y"};
  v.value(
      "path", o.path,
      {.doc = "numbered files (name_%04d.obj, .ply, .off, .stl, .vtp, .pvtp), a folder of them, "
              "a .pvd or .series, one mesh, or run:<topic>/<experiment>/<variant>",
       .required = true,
       .named = Named::file_or_folder});
  v.value("part", o.part, {.doc = "part to read of a folder or .pvd that holds several"});
  describe_choice(v, "up", o.up, kUp, {.doc = "axis of the files that points up; no sidecar: z"});
  v.value("scale", o.scale,
          {.doc = "metres a unit of the files; default: sidecar, else 1", .min = 1e-9, .max = 1e9});
  v.value(
      "frames_per_second", o.frames_per_second,
      {.doc = "default: sidecar, else times of the files, else 25", .unit = "1/s", .min = 1e-6});
  v.value("start", o.start,
          {.doc = "time of the first frame; default: sidecar, the files', else 0", .unit = "s"});
  v.value("first", o.first, {.doc = "number of the first frame to take"});
  v.value("last", o.last, {.doc = "number of the last frame to take"});
}

SequenceFiles find_sequence(const SequenceOptions& options, const fs::path& folder,
                            std::vector<std::string>& warnings, std::vector<fs::path>& inputs) {
  const fs::path path = located(options.path, folder);
  const std::string name = options.path;
  FoundFiles found = find_files(path, options.part);
  select(found, options, name);
  for (std::string& warning : found.warnings) warnings.push_back(std::move(warning));
  if (found.collection) inputs.push_back(*found.collection);
  for (const FoundFile& file : found.files) add_files(file, inputs);

  const fs::path sidecar_file = path.string() + ".json";
  SequenceSidecar sidecar;
  if (fs::is_regular_file(sidecar_file)) {
    sidecar = read_sidecar(sidecar_file);
    inputs.push_back(sidecar_file);
  }
  Clock clock;
  clock.frames_per_second =
      options.frames_per_second ? options.frames_per_second : sidecar.frames_per_second;
  clock.start = options.start ? options.start : sidecar.start;
  SequenceFiles sequence;
  sequence.files = timed(found.files, clock, name, warnings);
  sequence.y_up = options.up == UpAxis::y ||
                  (options.up == UpAxis::from_sidecar && sidecar.y_up.value_or(false));
  sequence.scale = options.scale.value_or(sidecar.scale.value_or(1));
  return sequence;
}

std::shared_ptr<SurfaceSequence> open_sequence(const SequenceOptions& options,
                                               const fs::path& folder,
                                               std::vector<std::string>& warnings,
                                               std::vector<fs::path>& inputs) {
  SequenceFiles found = find_sequence(options, folder, warnings, inputs);
  drop_empty_beginning(found.files, options.path, warnings);
  auto sequence =
      std::make_shared<MeshSequence>(std::move(found.files), found.y_up, found.scale, options.path);
  probe(*sequence, warnings);
  return sequence;
}

}  // namespace geoprior
