#include "testbed/view/render.h"

// figure.png and contact-sheet.png of a run.

#include "testbed/view/display.h"
#include "testbed/view/figure_layout.h"
#include "testbed/view/frame_times.h"

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
