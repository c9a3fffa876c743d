#pragma once

#include <string>

#include "experiments/sketch/fabrication/pattern_pdf.h"
#include "experiments/sketch/pattern/strain_sheet.h"

namespace geoprior::sketch {

/// A strain sheet as an SVG file in millimetres: a path for each colour, outlines, marks, texts.
std::string strain_svg(const StrainSheet& sheet);

/// The same as a page of a PDF file.
PdfExtraPage strain_pdf_page(const StrainSheet& sheet);

}  // namespace geoprior::sketch
