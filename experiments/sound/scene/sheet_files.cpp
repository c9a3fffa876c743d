#include "experiments/sound/scene/sheet_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/vtk/files.h"

namespace geoprior::sound {
namespace {

namespace fs = std::filesystem;

/// "…/tears_0012.vtp" of "…/surface_0012.vtp", when it is there.
std::optional<fs::path> tears_beside(const fs::path& surface) {
  const std::string name = surface.filename().string(), part = "surface_";
  if (name.rfind(part, 0) != 0 || surface.extension() != ".vtp") return {};
  const fs::path tears = surface.parent_path() / ("tears_" + name.substr(part.size()));
  if (!fs::is_regular_file(tears)) return {};
  return tears;
}

/// The left lips of a run's tears, tear by tear.
std::vector<TornPlace> read_tears(const fs::path& file, const SequenceFiles& files) {
  using On = NamedArray::On;
  std::optional<double> parameter;
  const Part part = read_foreign_vtk_part(file, parameter);
  if (part.points.rows() == 0) return {};
  const auto array = [&](const char* name, int components) -> const Eigen::MatrixXd& {
    return part.require_array(name, On::points, components, file.string()).values;
  };
  const Eigen::MatrixXd &pattern = array("pattern", 2), &time = array("time", 1);
  const Eigen::MatrixXd &tear = array("tear", 1), &lip = array("lip", 1);
  const Eigen::MatrixX3d points = in_metres_z_up(part.points, files.y_up, files.scale);
  std::vector<TornPlace> places;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (lip(i, 0) != 0) continue;
    places.push_back({static_cast<int>(tear(i, 0)), time(i, 0),
                      files.scale * pattern.row(i).transpose(), points.row(i).transpose()});
  }
  return places;
}

class SheetFiles final : public SheetAnimation {
 public:
  SheetFiles(SequenceFiles files, std::string name)
      : files_(std::move(files)), name_(std::move(name)) {}

  [[nodiscard]] int frame_count() const override { return static_cast<int>(files_.files.size()); }
  [[nodiscard]] double time(int frame) const override { return file(frame).time; }
  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] const fs::path& path(int frame) const { return file(frame).file; }

  [[nodiscard]] const std::set<std::string>& notes() const { return notes_; }

  /// Methods that are run one after the other ask for the same frames: they are kept, the first
  /// ones as long as they are not too many.
  [[nodiscard]] SheetSnapshot snapshot(int frame) const override {
    const std::lock_guard lock(mutex_);
    const auto found = kept_.find(frame);
    if (found != kept_.end()) return found->second;
    SheetSnapshot read = read_frame(frame);
    vertices_ += read.x.rows();
    constexpr Eigen::Index kMostVertices = 2'000'000;  // about 300 MB
    if (vertices_ <= kMostVertices) kept_.emplace(frame, read);
    return read;
  }

 private:
  [[nodiscard]] SheetSnapshot read_frame(int frame) const {
    const FrameFile& at = file(frame);
    MeshFile read = read_frame_file(at);
    for (const std::string& note : read.notes)
      notes_.insert(at.file.filename().string() + ": " + note);
    if (read.pattern.rows() != read.mesh.V.rows()) {
      throw Error("has no coordinates of the pattern", at.file.string(),
                  "a point array 'pattern' of two components (.vtp), or texture coordinates, one "
                  "for each vertex (.obj)");
    }
    SheetSnapshot out;
    out.time = at.time;
    out.mesh.pattern = files_.scale * read.pattern;
    out.mesh.triangles = std::move(read.mesh.F);
    out.x = in_metres_z_up(read.mesh.V, files_.y_up, files_.scale);
    out.v = in_metres_z_up(read.velocity, files_.y_up, files_.scale);
    if (const auto tears = tears_beside(at.file)) out.torn = read_tears(*tears, files_);
    require_valid(out, at.file.string());
    return out;
  }

  [[nodiscard]] const FrameFile& file(int frame) const {
    if (frame >= 0 && frame < frame_count()) return files_.files[frame];
    throw Error("has no frame " + std::to_string(frame), name_,
                "0 to " + std::to_string(frame_count() - 1));
  }

  SequenceFiles files_;
  std::string name_;
  mutable std::mutex mutex_;
  mutable std::map<int, SheetSnapshot> kept_;
  mutable std::set<std::string> notes_;  ///< of the frames that were read
  mutable Eigen::Index vertices_ = 0;    ///< of all frames read
};

void require_of_sheet(const SheetSnapshot& frame, const Pattern& pattern, const fs::path& file) {
  const Eigen::AlignedBox2d asked = bounding_box(pattern);
  const Eigen::Vector2d low = frame.mesh.pattern.colwise().minCoeff().transpose();
  const Eigen::Vector2d high = frame.mesh.pattern.colwise().maxCoeff().transpose();
  const double off = std::max((low - asked.min()).cwiseAbs().maxCoeff(),
                              (high - asked.max()).cwiseAbs().maxCoeff());
  constexpr double kMostOff = 0.01;
  if (off <= kMostOff * width(pattern)) return;
  std::ostringstream text, allowed;
  text << "is of another sheet: its pattern reaches from (" << low.transpose() << ") to ("
       << high.transpose() << ") m";
  allowed << "scene.pattern: (" << asked.min().transpose() << ") to (" << asked.max().transpose()
          << ") m";
  throw Error(text.str(), file.string(), allowed.str());
}

}  // namespace

void describe(OptionVisitor& v, SheetFileOptions& o) {
  describe(v, o.sequence);
  v.value("every", o.every,
          {.doc = "n: the first frame and every n-th after it are taken", .min = 1});
}

std::shared_ptr<const SheetAnimation> open_sheet_files(const SheetFileOptions& options,
                                                       const fs::path& folder,
                                                       const Pattern& pattern,
                                                       std::vector<std::string>& warnings,
                                                       std::vector<fs::path>& inputs) {
  std::vector<fs::path> found;
  SequenceFiles files = find_sequence(options.sequence, folder, warnings, found);
  const std::size_t all = files.files.size();
  std::set<fs::path> passed_over;
  std::size_t number = 0;
  std::erase_if(files.files, [&](const FrameFile& file) {
    const bool passes = number++ % static_cast<std::size_t>(options.every) != 0;
    if (passes) passed_over.insert(file.file);
    return passes;
  });
  if (all > 1 && files.files.size() == 1) {
    throw Error("every = " + std::to_string(options.every) + " leaves one of " +
                    std::to_string(all) + " frames",
                options.sequence.path, "1 to " + std::to_string(all - 1));
  }
  std::copy_if(found.begin(), found.end(), std::back_inserter(inputs),
               [&](const fs::path& file) { return !passed_over.contains(file); });
  for (std::size_t i = 1; i < files.files.size(); ++i) {
    if (files.files[i].time > files.files[i - 1].time) continue;
    throw Error("has the time " + std::to_string(files.files[i].time) + " s after " +
                    std::to_string(files.files[i - 1].time) + " s",
                files.files[i].file.string(), "times that increase strictly");
  }
  for (const FrameFile& file : files.files) {
    if (const auto tears = tears_beside(file.file)) inputs.push_back(*tears);
  }
  auto sheet = std::make_shared<SheetFiles>(std::move(files), options.sequence.path);
  const int last = sheet->frame_count() - 1;
  for (const int i : {0, last / 2, last}) {
    require_of_sheet(sheet->snapshot(i), pattern, sheet->path(i));
  }
  warnings.insert(warnings.end(), sheet->notes().begin(), sheet->notes().end());
  return sheet;
}

}  // namespace geoprior::sound
