#include "experiments/sketch/fabrication/fabrication.h"

#include <array>
#include <string_view>

#include "experiments/sketch/fabrication/pattern_dxf.h"
#include "experiments/sketch/fabrication/pattern_map.h"
#include "experiments/sketch/fabrication/pattern_pdf.h"
#include "experiments/sketch/fabrication/pattern_svg.h"
#include "experiments/sketch/pattern/sheet_layout.h"

namespace geoprior::sketch {

void describe(OptionVisitor& v, FabricationOptions& options) {
  static constexpr std::array<std::string_view, 3> kPapers{"sheet", "a4", "letter"};
  describe(v, options.sheet);
  describe_group(v, "layers", options.layers, {.doc = "colours for laser cutters"});
  describe_choice(v, "page", options.pages.paper, kPapers,
                  {.doc = "paper: one sheet as large as the pattern, or pages to join"});
  v.value("margin_mm", options.pages.margin_mm,
          {.doc = "blank border of a page", .unit = "mm", .min = 0, .max = 50});
  v.value("overlap_mm", options.pages.overlap_mm,
          {.doc = "overlap of neighbouring pages", .unit = "mm", .min = 0, .max = 50});
  v.value("cloth", options.cloth,
          {.doc = "whether garment.obj and garment.json are written, for cloth simulators"});
}

std::vector<FabricationFile> fabrication_files(const Pattern& pattern,
                                               const FabricationOptions& options) {
  const PatternSheet sheet = pattern_sheet(pattern, options.sheet);
  const std::vector<SheetPage> pages = sheet_pages(sheet, options.pages);
  const SheetPage whole = whole_sheet(sheet);
  std::vector<FabricationFile> files;
  files.push_back({"pattern.svg", svg_page(sheet, whole, options.layers)});
  files.push_back({"pattern.dxf", dxf_drawing(sheet)});
  files.push_back({"pattern.pdf", pdf_document(sheet, pages, options.layers)});
  files.push_back({"pattern.csv", pattern_map_csv(pattern, sheet)});
  files.push_back({"pattern.json", pattern_json(pattern, sheet)});
  for (const SheetPage& page : pages) {
    if (page.label.empty()) continue;
    files.push_back({"pattern-" + page.label + ".svg", svg_page(sheet, page, options.layers)});
  }
  return files;
}

}  // namespace geoprior::sketch
