#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/catalogue.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/commands/outcome.h"
#include "testbed/commands/pictures.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/view/export.h"
#include "testbed/view/media/spectrogram.h"
#include "testbed/view/media/video.h"
#include "testbed/view/render.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

/// The view of another experiment, or the one that the run was recorded with.
FigureView view_of(const OpenedRun& run, const std::optional<std::string>& experiment,
                   const std::vector<Topic>& topics) {
  if (experiment) return load_experiment(experiment_file(*experiment), topics, {}).view;
  const std::string file = (run.folder() / "run.h5").string();
  return figure_view_of(run.record().experiment_toml, file, topics);
}

/// One line a run: its claims, and its picture where there is one. Damage is named here, before
/// Python meets it.
std::vector<std::vector<std::string>> overview(const std::vector<fs::path>& folders,
                                               Unverified unverified) {
  std::vector<std::vector<std::string>> rows{{"experiment", "claims", "picture"}};
  for (const fs::path& folder : folders) {
    throw_if_stopped();
    const OpenedRun run(folder, unverified);
    require_recorded_files(run);
    const fs::path figure = folder / "figure.png";
    rows.push_back({run.record().experiment_id, claim_count_text(run.record().claims),
                    fs::exists(figure) ? figure.string() : "-"});
  }
  return rows;
}

/// The page of what is committed: no run is read, none is needed.
int published_report(const CommandContext& context, const ReportRequest& request) {
  const fs::path page = request.out ? fs::path(*request.out) : runs_root() / "published.html";
  if (!request.out) fs::create_directories(page.parent_path());
  make_published_report(page);
  say("report   " + page.string());
  if (context.json) print_json({{"report", page.string()}});
  return done;
}

}  // namespace

int render_command(const CommandContext& context, const RenderRequest& request) {
  install_stop_handler();
  const fs::path folder = run_folder_of(request.run);
  const OpenedRun run(folder, request.unverified);
  const FigureView view = view_of(run, request.view, context.topics);
  render_run(run, view);
  const fs::path figure = folder / "figure.png";
  say("picture  " + figure.string());
  nlohmann::ordered_json result{{"run", folder.string()}, {"figure", figure.string()}};
  for (const fs::path& drawn : draw_spectrograms(run, view)) {
    say("sound    " + drawn.string());
    result["spectrograms"].push_back(drawn.string());
  }
  if (context.json) print_json(result);
  return done;
}

int video_command(const CommandContext& context, const VideoRequest& request) {
  const fs::path folder = run_folder_of(request.run);
  VideoOptions options;
  options.frames_per_second = request.frames_per_second;
  options.out = request.out ? fs::path(*request.out) : path_below(folder, "video");
  install_stop_handler();
  const OpenedRun run(folder, request.unverified);
  const Video video = make_video(run, view_of(run, request.view, context.topics), options);
  say("frames   " + std::to_string(video.frames) + " in " + options.out.string());
  if (video.stopped) {
    say("stopped before the last frame: no video");
  } else if (video.file) {
    say("video    " + video.file->string());
    if (video.sound_of) say("sound    of " + *video.sound_of + ", in real time");
  } else {
    say("no video: ffmpeg is not on the PATH (apt-get install ffmpeg); the frames are there");
  }
  if (!video.no_sound.empty()) say("no sound: " + video.no_sound);
  if (context.json) {
    nlohmann::ordered_json result{{"run", folder.string()}, {"frames", video.frames}};
    result["out"] = options.out.string();
    result["video"] = video.file ? nlohmann::ordered_json(video.file->string()) : nullptr;
    result["sound_of"] = video.sound_of ? nlohmann::ordered_json(*video.sound_of) : nullptr;
    print_json(result);
  }
  return video.stopped ? wrong_use : done;
}

int report_command(const CommandContext& context, const ReportRequest& request) {
  install_stop_handler();
  if (request.published) return published_report(context, request);
  std::vector<fs::path> folders;
  for (const std::string& run : request.runs) folders.push_back(run_folder_of(run));
  if (request.runs.empty()) {
    for (const CatalogueEntry& entry : catalogue()) {
      try {
        folders.push_back(run_folder_of(entry.id));
      } catch (const Error&) {
        say(tinted(entry.id + " has no run", Tint::faint));
      }
    }
  }
  if (folders.empty()) throw Error("there are no runs", runs_root().string(), "geoprior run <id>");
  const std::vector<std::vector<std::string>> runs_found = overview(folders, request.unverified);
  fs::path page =
      folders.size() == 1 ? folders.front() / "report.html" : runs_root() / "report.html";
  if (request.out) page = *request.out;
  make_report(folders, page, request.unverified);
  say_table(runs_found);
  say("report   " + page.string());
  if (context.json) {
    nlohmann::ordered_json runs = nlohmann::ordered_json::array();
    for (const fs::path& folder : folders) runs.push_back(folder.string());
    print_json({{"report", page.string()}, {"runs", runs}});
  }
  return done;
}

int export_command(const CommandContext& context, const ExportRequest& request) {
  install_stop_handler();
  const fs::path folder = run_folder_of(request.run);
  const fs::path out =
      request.out ? fs::path(*request.out) : path_below(folder, "export-" + request.format);
  export_run(OpenedRun(folder, request.unverified), request.format, out);
  say("exported to " + out.string());
  if (context.json) {
    print_json({{"run", folder.string()}, {"format", request.format}, {"out", out.string()}});
  }
  return done;
}

}  // namespace geoprior
