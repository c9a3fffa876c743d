#include "experiments/sketch/sketch_command.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "experiments/sketch/command/chosen_snap.h"
#include "experiments/sketch/command/drawn_experiment.h"
#include "experiments/sketch/command/overview_picture.h"
#include "experiments/sketch/command/result_folder.h"
#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/scene/scene.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/runner/execute.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/streams.h"
#include "testbed/view/display.h"
#include "testbed/view/mesh_text.h"

namespace geoprior::sketch {
namespace {

namespace fs = std::filesystem;

/// What files of a result are for; others go without a word.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kFileWords{{
    {"picture.png", "the drawing, the surface and its pieces"},
    {"pattern.svg", "pieces in true size, for laser cutters and drawing programs"},
    {"pattern.pdf", "the same to print"},
    {"pattern.dxf", "the same for pattern and CAD programs"},
    {"pattern-strain.svg", "the pieces coloured by how much they are strained"},
    {"pattern-verdict.txt", "one line a piece: can it be cut and sewn"},
    {"pattern-refused.txt", "what cannot be cut, and why"},
    {"pattern.csv", "points of the pattern and of the surface"},
    {"pattern.json", "pieces, seams and notches for programs"},
    {"surface.obj", "the surface, in metres"},
    {"model.obj", "the surface with the photograph's colours"},
    {"textured-pattern.svg", "the pieces with the photograph's colours"},
    {"layers.glb", "the layers as they move"},
    {"run", "frames and numbers of the run, for geoprior render, export and report"},
}};

/// The drawing, read once more than the run does: what is wrong with it is said before any folder
/// is made, and its kind decides on the method.
struct ReadSketch {
  fs::path drawing;
  std::optional<fs::path> photo;
  std::shared_ptr<SketchScene> scene;
};

fs::path existing(const std::string& file, const char* what) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) throw Error(std::string("there is no such ") + what, file);
  if (fs::is_directory(file, ignored))
    throw Error("is a folder", file, std::string("the file of a ") + what);
  return file;
}

ReadSketch read_sketch(const std::string& input, const SketchCommandOptions& options) {
  ReadSketch read;
  read.drawing = existing(input, "drawing");
  SketchSceneOptions scene;
  scene.drawing = fs::absolute(read.drawing).string();
  if (options.photo) {
    read.photo = existing(*options.photo, "photograph");
    scene.photo = fs::absolute(*read.photo).string();
  }
  read.scene = load_sketch_scene(scene, ".", 1);
  if (read.photo && drawn_kind(read.scene->input.drawing) != DrawnKind::one_view)
    throw Error("rigid layers take no photograph", read.photo->string(), "no --photo");
  return read;
}

/// The one view's picture; absent where it has none, or the drawing other views.
std::optional<PixelImage> decoded_photo(const SketchScene& scene) {
  const View* view = scene.input.drawing.find(ViewKind::photo);
  if (view == nullptr || view->picture.size == Eigen::Vector2d::Zero()) return std::nullopt;
  return read_picture(view->picture);
}

std::string command_words(const ReadSketch& read, const SketchCommandOptions& options) {
  std::string words = "geoprior sketch " + printable(read.drawing.filename().string());
  if (read.photo) words += " --photo " + printable(read.photo->filename().string());
  if (options.force) words += " --force";
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words;
}

DrawnExperiment drawn_experiment(const ReadSketch& read, const SketchCommandOptions& options,
                                 const fs::path& folder, bool has_photo) {
  DrawnExperiment experiment;
  experiment.title = printable(read.drawing.stem().string());
  experiment.command = command_words(read, options);
  experiment.drawing = path_from(folder, read.drawing);
  if (read.photo) experiment.photo = path_from(folder, *read.photo);
  experiment.kind = drawn_kind(read.scene->input.drawing);
  experiment.textured = has_photo && experiment.kind == DrawnKind::one_view;
  experiment.force = options.force;
  return experiment;
}

const VariantRecord& only_variant(const ExecuteResult& result) {
  return result.record.cases.front().variants.front();
}

/// Runs the experiment as if its file were in the folder already.
ExecuteResult run_drawn(const std::string& text, const fs::path& file, ResultFolder& folder,
                        const std::vector<Topic>& topics) {
  const Experiment experiment = load_recorded_experiment(text, file.string(), file, topics);
  ExecuteRequest request;
  request.out = folder.unfinished() / "run";
  request.timing = false;
  request.show_progress = ::isatty(STDERR_FILENO) == 1;
  request.farewell = [&folder](const fs::path&) {
    folder.discard();
    say("stopped");
  };
  ExecuteResult result = execute(experiment, topics, request);
  if (result.stopped) throw Stopped();
  if (only_variant(result).status != "done") throw Error(only_variant(result).error);
  return result;
}

/// Files of the run that its user looks for come up beside it.
void copy_files(const OpenedRun& run, const VariantRecord& variant, const fs::path& folder) {
  for (const StoredFile& stored : variant.artifacts) {
    const fs::path file = run.file(stored);
    write_file_atomically(folder / file.filename(), read_whole_file(file));
  }
}

std::optional<Part> last_part(const OpenedRun& run, const VariantRecord& variant,
                              const std::string& name) {
  for (const StoredFile& stored : variant.frames.back().files) {
    const std::string file = fs::path(stored.name).filename().string();
    if (file.starts_with(name + "_")) return run.part(stored);
  }
  return std::nullopt;
}

/// What is written on the pieces of the picture: the names in the lines of their verdicts, which
/// begin with "piece 1 of 3 'sole': ".
std::vector<std::string> piece_names(const std::string& verdicts) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < verdicts.size();) {
    const std::size_t end = std::min(verdicts.find('\n', at), verdicts.size());
    const std::string head = verdicts.substr(at, std::min(verdicts.find(": ", at), end) - at);
    const std::size_t first = head.find('\''), last = head.rfind('\'');
    names.push_back(first < last ? head.substr(first + 1, last - first - 1) : head);
    at = end + 1;
  }
  return names;
}

/// A file of the result; empty where there is none of that name.
std::string text_in(const fs::path& folder, const char* name) {
  std::error_code ignored;
  return fs::exists(folder / name, ignored) ? read_whole_file(folder / name) : "";
}

void draw_picture(const ReadSketch& read, const OpenedRun& run, const VariantRecord& variant,
                  std::optional<PixelImage> photo, const fs::path& folder) {
  Overview overview;
  overview.title = printable(read.drawing.stem().string());
  overview.drawing = read.scene->input.drawing;
  overview.photo = std::move(photo);
  overview.surface = *last_part(run, variant, "surface");
  overview.strokes = last_part(run, variant, "strokes");
  if (!overview.strokes) overview.strokes = last_part(run, variant, "rims");
  overview.pattern = last_part(run, variant, "pattern");
  overview.pieces = piece_names(text_in(folder, "pattern-verdict.txt"));
  overview.subtitle = drawn_kind_text(overview.drawing);
  if (!overview.pieces.empty()) {
    overview.subtitle += ", " + std::to_string(overview.pieces.size()) +
                         (overview.pieces.size() == 1 ? " piece" : " pieces");
  }
  const Display display;
  write_png(draw_overview(overview), folder / "picture.png");
}

std::string word_of(const std::string& file) {
  for (const auto& [name, word] : kFileWords) {
    if (name == file) return std::string(word);
  }
  return "";
}

/// The experiment, what has a word in the order of their table, and the rest.
std::string listing(const fs::path& folder, const fs::path& experiment) {
  constexpr std::size_t kNameWidth = 24;
  std::vector<std::string> names{experiment.string()};
  for (const auto& [name, word] : kFileWords) names.emplace_back(name);
  const std::size_t known = names.size();
  for (const fs::path& entry : sorted_entries(folder)) {
    const std::string name = entry.filename().string();
    if (is_temporary_file(entry) || std::count(names.begin(), names.begin() + known, name) > 0)
      continue;
    names.push_back(name);
  }
  std::string text = folder.string() + "\n";
  std::error_code ignored;
  for (const std::string& name : names) {
    if (!fs::exists(folder / name, ignored)) continue;
    const std::string word = name == experiment ? "the experiment: edit it, then geoprior run " +
                                                      (folder / name).string()
                                                : word_of(name);
    const std::size_t gap = name.size() < kNameWidth ? kNameWidth - name.size() : 1;
    text += "  " + name + (word.empty() ? "" : std::string(gap, ' ') + word) + "\n";
  }
  return text;
}

CommandText result_text(const ReadSketch& read, const fs::path& folder, const fs::path& file,
                        bool force) {
  CommandText out;
  const std::string verdicts = text_in(folder, "pattern-verdict.txt");
  const std::string refused = text_in(folder, "pattern-refused.txt");
  out.text = printable(read.drawing.filename().string() + ": " +
                       drawn_kind_text(read.scene->input.drawing) + "\n" + listing(folder, file) +
                       verdicts);
  if (refused.empty()) return out;
  out.fell_short = verdicts.empty() || !force;
  if (verdicts.empty()) {
    out.notices.push_back("there is no pattern to cut: " + refused);
  } else if (force) {
    out.notices.push_back("pieces that are refused are among the files to cut by: --force");
  } else {
    out.notices.push_back(
        "pieces are refused, and not in the files to cut by (--force writes them all the same)");
  }
  return out;
}

CommandText sketch(const std::string& input, const SketchCommandOptions& options,
                   const std::vector<Topic>& topics) {
  const ReadSketch read = read_sketch(input, options);
  std::optional<PixelImage> photo = decoded_photo(*read.scene);
  install_stop_handler();
  ResultFolder folder(options.out ? fs::path(*options.out) : unused_result_folder(read.drawing));
  const fs::path file = read.drawing.stem().string() + ".toml";
  DrawnExperiment experiment = drawn_experiment(read, options, folder.path(), photo.has_value());
  if (experiment.kind == DrawnKind::one_view) experiment.snap = chosen_snap(read.scene->photo());
  const std::string text = experiment_text(experiment);
  const ExecuteResult result = run_drawn(text, folder.path() / file, folder, topics);
  const OpenedRun run(result.folder, result.record);
  const VariantRecord& variant = only_variant(result);
  const fs::path& made = folder.unfinished();
  copy_files(run, variant, made);
  if (const std::optional<Part> surface = last_part(run, variant, "surface"))
    write_file_atomically(made / "surface.obj",
                          part_to_obj(*surface, read.drawing.filename().string()));
  draw_picture(read, run, variant, std::move(photo), made);
  write_file_atomically(made / file, text);
  throw_if_stopped();
  folder.commit(file);
  CommandText out = result_text(read, folder.path(), file, options.force);
  if (experiment.snap) {
    out.notices.push_back("ends of borders are joined within " +
                          rounded_text(100 * *experiment.snap) +
                          " % of the drawing's diagonal: joined as far as usual, they pull the "
                          "borders away from where they were drawn");
  }
  return out;
}

}  // namespace

void describe(OptionVisitor& v, SketchCommandOptions& options) {
  v.value("photo", options.photo,
          {.doc = "the photograph that one view was traced over (PNG, JPEG): its colours are "
                  "carried over",
           .named = Named::file});
  v.value("out", options.out,
          {.doc = "folder of the result, new or empty; without it <drawing>-sketch beside the "
                  "drawing",
           .named = Named::folder});
  v.value("force", options.force,
          {.doc = "write pieces to be cut although their strain refuses them"});
}

TopicCommand sketch_command(Topic (*topic)()) {
  return topic_command<SketchCommandOptions>(
      "sketch", "surface, sewing pattern and picture of an annotated drawing", "drawing",
      "SVG with layers view:front, view:side, view:top, or view:photo",
      [topic](const std::string& input, const SketchCommandOptions& options) {
        return sketch(input, options, {topic()});
      });
}

}  // namespace geoprior::sketch
