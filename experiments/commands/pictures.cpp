#include "experiments/commands/pictures.h"

#include "core/error.h"
#include "experiments/view/view.h"

namespace geoprior {

namespace fs = std::filesystem;

void make_report(const std::vector<fs::path>& run_folders, const fs::path& page) {
  std::vector<std::string> arguments{"--out", page.string()};
  for (const fs::path& folder : run_folders) arguments.push_back(folder.string());
  run_python("report", arguments);
}

Pictures make_pictures(const fs::path& run_folder, const FigureView& view) {
  Pictures pictures;
  const auto attempt = [&](const auto& body) {
    try {
      body();
    } catch (const Error& error) {
      pictures.error += (pictures.error.empty() ? "" : "; ") + std::string(error.what());
    }
  };
  attempt([&] {
    render_run(run_folder, view);
    pictures.figure = run_folder / "figure.png";
  });
  attempt([&] { run_python("plots", {run_folder.string()}); });
  attempt([&] { run_python("summary", {run_folder.string()}); });
  attempt([&] {
    make_report({run_folder}, run_folder / "report.html");
    pictures.report = run_folder / "report.html";
  });
  return pictures;
}

}  // namespace geoprior
