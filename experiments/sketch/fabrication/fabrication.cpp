#include "experiments/sketch/fabrication/fabrication.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "experiments/sketch/fabrication/pattern_dxf.h"
#include "experiments/sketch/fabrication/pattern_map.h"
#include "experiments/sketch/fabrication/pattern_pdf.h"
#include "experiments/sketch/fabrication/pattern_svg.h"
#include "experiments/sketch/fabrication/strain_page.h"
#include "experiments/sketch/pattern/piece_verdict.h"
#include "experiments/sketch/pattern/sheet_layout.h"
#include "experiments/sketch/pattern/strain_sheet.h"

namespace geoprior::sketch {
namespace {

/// The files to cut by.
std::vector<FabricationFile> cut_files(const Pattern& pattern, const PatternSheet& sheet,
                                       const FabricationOptions& options,
                                       std::span<const PdfExtraPage> more) {
  std::vector<FabricationFile> files;
  const std::vector<SheetPage> pages = sheet_pages(sheet, options.pages);
  files.push_back({"pattern.svg", svg_page(sheet, whole_sheet(sheet), options.layers)});
  files.push_back({"pattern.dxf", dxf_drawing(sheet)});
  files.push_back({"pattern.pdf", pdf_document(sheet, pages, options.layers, more)});
  for (const SheetPage& page : pages) {
    if (page.label.empty()) continue;
    files.push_back({"pattern-" + page.label + ".svg", svg_page(sheet, page, options.layers)});
  }
  files.push_back({"pattern.csv", pattern_map_csv(pattern, sheet)});
  files.push_back({"pattern.json", pattern_json(pattern, sheet)});
  return files;
}

/// A cut for the piece whose pattern loses most area to strain, of those that are strained or
/// refused.
void add_worst_seam(const Pattern& pattern, const Eigen::MatrixX3d& surface,
                    std::vector<PieceVerdict>& verdicts) {
  std::size_t worst = verdicts.size();
  const auto lost = [&](std::size_t k) { return (1 - verdicts[k].share) * verdicts[k].area; };
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    if (!verdicts[k].is_strained() && verdicts[k].refused.empty()) continue;
    if (worst == verdicts.size() || lost(k) > lost(worst)) worst = k;
  }
  if (worst < verdicts.size()) verdicts[worst].seam = added_seam(pattern.pieces[worst], surface);
}

}  // namespace

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
  v.value("force", options.force,
          {.doc = "whether pieces are written to be cut although their strain refuses them"});
  v.value("add_seam", options.add_seam,
          {.doc = "whether a cut is suggested for the worst of the pieces that are strained"});
}

std::vector<FabricationFile> fabrication_files(const Pattern& pattern,
                                               const FabricationOptions& options) {
  return cut_files(pattern, pattern_sheet(pattern, options.sheet), options, {});
}

std::vector<FabricationFile> judged_fabrication_files(const Pattern& pattern,
                                                      const Eigen::MatrixX3d& surface,
                                                      const FabricationOptions& options) {
  std::vector<PieceVerdict> verdicts = judge_pieces(pattern, surface);
  const PatternSheet sheet = judged_sheet(pattern, options.sheet, options.force, verdicts);
  if (options.add_seam) add_worst_seam(pattern, surface, verdicts);
  const StrainSheet strain = strain_sheet(pattern, surface, verdicts);
  std::vector<FabricationFile> files;
  std::string lines, refused;
  std::size_t refusals = 0;
  for (int k = 0; k < std::ssize(verdicts); ++k) {
    lines += verdict_line(pattern, k, verdicts[k]) + "\n";
    if (verdicts[k].refused.empty()) continue;
    refused += counted_piece(pattern, k) + ": " + verdicts[k].refused + "\n";
    ++refusals;
  }
  if (refusals < verdicts.size()) {
    const PdfExtraPage page = strain_pdf_page(strain);
    files = cut_files(pattern, sheet, options, {&page, 1});
  }
  files.push_back({"pattern-strain.svg", strain_svg(strain)});
  files.push_back({"pattern-verdict.txt", lines});
  if (refusals > 0) files.push_back({"pattern-refused.txt", refused});
  return files;
}

}  // namespace geoprior::sketch
