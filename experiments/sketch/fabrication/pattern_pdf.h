#pragma once

#include <span>
#include <string>

#include "experiments/sketch/fabrication/layer_style.h"
#include "experiments/sketch/fabrication/pattern_tiles.h"
#include "experiments/sketch/pattern/sheet.h"

namespace geoprior::sketch {

/// A page beside those of the pattern.
struct PdfExtraPage {
  Eigen::Vector2d size{0, 0};  ///< mm
  std::string content;         ///< operators that count in millimetres; the font is /F1
};

/// A pattern as a PDF 1.4 file at true scale, one page of it for each of `pages`.
///
/// Contents are not compressed and count in millimetres (the first operator scales by 72 / 25.4).
/// Text is set in Helvetica, which every reader has; characters outside of Latin-1 become '?'. No
/// date is written: the same pattern gives the same bytes. Print at 100 %, not "fit to page".
///
/// @param pages   at least one (pattern_tiles.h)
/// @param more    pages after them
/// @throws Error  without a page, or for a colour that is none (layer_style.h)
/// Source: Adobe 2001, PDF Reference, version 1.4.
std::string pdf_document(const PatternSheet& sheet, std::span<const SheetPage> pages,
                         const LayerStyle& style, std::span<const PdfExtraPage> more = {});

}  // namespace geoprior::sketch
