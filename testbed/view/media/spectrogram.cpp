#include "testbed/view/media/spectrogram.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "testbed/formats/folders.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/scene_camera.h"
#include "testbed/view/display.h"
#include "testbed/view/figure/frame_times.h"
#include "testbed/view/figure/layout.h"
#include "testbed/view/media/sound_track.h"
#include "testbed/view/python.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostVariants = 6;  ///< as MOST_BLOCKS of spectrogram.py
constexpr int kFrames = 6;                ///< states side by side that are not wrapped
constexpr int kPanelWidth = 400;

/// A file that is gone with this object.
class PassingFile {
 public:
  explicit PassingFile(fs::path file) : file_(std::move(file)) {}
  ~PassingFile() {
    std::error_code stays;
    fs::remove(file_, stays);
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;
  [[nodiscard]] const fs::path& path() const { return file_; }

 private:
  fs::path file_;
};

/// Of the times those nearest to the middles of `count` equal parts of their range, so that
/// pictures side by side stand over their times.
std::vector<double> middles(const std::vector<double>& times, int count) {
  std::vector<double> chosen;
  for (int i = 0; i < count && !times.empty(); ++i) {
    const double wanted = times.front() + (i + 0.5) / count * (times.back() - times.front());
    const double nearest = *std::min_element(times.begin(), times.end(), [&](double a, double b) {
      return std::abs(a - wanted) < std::abs(b - wanted);
    });
    if (chosen.empty() || chosen.back() != nearest) chosen.push_back(nearest);
  }
  return chosen;
}

/// The frames of the variants that the view names: a row a variant, a column a time.
FigureBlock frames_block(const OpenedRun& run, const FigureView& view) {
  const RunRecord& record = run.record();
  FigureView strip = contact_sheet_view(record, view);
  strip.parameters = middles(frame_parameters(record, view), kFrames);
  return std::move(make_blocks(run, strip).front());
}

/// Of the columns, "0.5,1.5": those of the first row that has a frame there.
std::string times_text(const FigureBlock& block) {
  std::string text;
  for (std::size_t c = 0; c < block.rows.front().cells.size(); ++c) {
    for (const FigureRow& row : block.rows) {
      if (!row.cells[c].parameter) continue;
      text += (text.empty() ? "" : ",") + number_text(*row.cells[c].parameter);
      break;
    }
  }
  return text;
}

/// Into `file`, of the view's first case.
/// @return  whether there is a sound
bool draw_first_case(const OpenedRun& run, FigureView view, const fs::path& file) {
  const RunRecord& record = run.record();
  std::vector<const VariantRecord*> variants = sounding_variants(record, view);
  if (variants.empty()) return false;
  variants.resize(std::min(variants.size(), kMostVariants));
  const CaseRecord& of = *first_drawn_case(record, view);
  std::vector<std::string> arguments{run.folder().string(), "--case", of.name, "--out",
                                     file.string()};
  if (run.unverified() == Unverified::used) arguments.emplace_back("--force");
  view.variants.clear();
  for (const VariantRecord* variant : variants) {
    view.variants.push_back(variant->name);
    arguments.insert(arguments.end(), {"--variant", variant->name});
  }
  const PassingFile frames(path_below(run.folder(), "strip-of-frames.png"));
  if (has_times(of) && !frame_parameters(record, view).empty()) {
    const FigureBlock block = frames_block(run, view);
    const Display display;
    write_png(draw_panels(block, kPanelWidth), frames.path());
    arguments.insert(arguments.end(),
                     {"--frames", frames.path().string(), "--times", times_text(block)});
  }
  run_python("spectrogram", arguments);
  return true;
}

}  // namespace

std::vector<fs::path> draw_spectrograms(const OpenedRun& run, const FigureView& wanted) {
  FigureView view = with_scene_camera(wanted, run.record(), (run.folder() / "run.h5").string());
  std::vector<std::string> cases = view.cases;
  if (const CaseRecord* first = first_drawn_case(run.record(), view); first && cases.empty()) {
    cases = {first->name};
  }
  std::vector<fs::path> drawn;
  for (const std::string& name : cases) {
    view.cases = {name};
    const std::string file = drawn.empty() ? "spectrogram.png" : "spectrogram-" + name + ".png";
    const fs::path path = path_below(run.folder(), file);
    if (draw_first_case(run, view, path)) drawn.push_back(path);
  }
  return drawn;
}

}  // namespace geoprior
