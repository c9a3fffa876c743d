#include "testbed/commands/pictures.h"

#include <functional>

#include "core/error.h"
#include "testbed/home.h"
#include "testbed/view/media/spectrogram.h"
#include "testbed/view/python.h"
#include "testbed/view/render.h"

namespace geoprior {

namespace fs = std::filesystem;

void make_report(const std::vector<fs::path>& run_folders, const fs::path& page,
                 Unverified unverified) {
  std::vector<std::string> arguments{"--out", page.string()};
  if (unverified == Unverified::used) arguments.emplace_back("--force");
  for (const fs::path& folder : run_folders) arguments.push_back(folder.string());
  run_python("report", arguments);
}

void make_published_report(const fs::path& page) {
  run_python("published", {"--root", geoprior_home().string(), "--out", page.string()});
}

namespace {

/// Runs one step; what it cannot do is told beside what the others cannot.
void attempt(std::string& problems, const std::function<void()>& step) {
  try {
    step();
  } catch (const Error& error) {
    problems += (problems.empty() ? "" : "; ") + std::string(error.what());
  }
}

}  // namespace

Pictures make_pictures(const fs::path& run_folder, const FigureView& view) {
  Pictures pictures;
  attempt(pictures.error, [&] {
    render_run(OpenedRun(run_folder), view);
    pictures.figure = run_folder / "figure.png";
  });
  attempt(pictures.error,
          [&] { pictures.spectrograms = draw_spectrograms(OpenedRun(run_folder), view); });
  attempt(pictures.error, [&] { run_python("plots", {run_folder.string()}); });
  attempt(pictures.error, [&] {
    run_python("summary", {run_folder.string()});
    pictures.summary = run_folder / "summary.md";
  });
  attempt(pictures.error, [&] {
    make_report({run_folder}, run_folder / "report.html");
    pictures.report = run_folder / "report.html";
  });
  return pictures;
}

}  // namespace geoprior
