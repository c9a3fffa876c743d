#include "testbed/view/render.h"

// figure.png and contact-sheet.png of a run.

#include "testbed/runner/scene_camera.h"
#include "testbed/view/display.h"
#include "testbed/view/figure/frame_times.h"
#include "testbed/view/figure/layout.h"

namespace geoprior {

namespace fs = std::filesystem;

void render_run(const OpenedRun& run, const FigureView& wanted) {
  const FigureView view =
      with_scene_camera(wanted, run.record(), (run.folder() / "run.h5").string());
  const std::vector<FigureBlock> blocks = make_blocks(run, view);
  const Display display;
  write_png(draw_figure(blocks), run.folder() / "figure.png");
  if (view.contact_sheet > 0) {
    const FigureView sheet = contact_sheet_view(run.record(), view);
    write_png(draw_figure(make_blocks(run, sheet)), run.folder() / "contact-sheet.png");
  }
}

}  // namespace geoprior
