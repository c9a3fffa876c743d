// figure.png and contact-sheet.png of a run.

#include "experiments/view/display.h"
#include "experiments/view/figure_layout.h"
#include "experiments/view/frame_times.h"
#include "experiments/view/view.h"

namespace geoprior {

namespace fs = std::filesystem;

void render_run(const fs::path& run_folder, const FigureView& view) {
  const RunRecord record = read_run_file(run_folder / "run.h5");
  const std::vector<FigureBlock> blocks = make_blocks(record, run_folder, view);
  const Display display;
  write_png(draw_figure(blocks), run_folder / "figure.png");
  if (view.contact_sheet > 0) {
    const FigureView sheet = contact_sheet_view(record, view);
    write_png(draw_figure(make_blocks(record, run_folder, sheet)),
              run_folder / "contact-sheet.png");
  }
}

}  // namespace geoprior
