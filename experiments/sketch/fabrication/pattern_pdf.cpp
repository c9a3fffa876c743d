#include "experiments/sketch/fabrication/pattern_pdf.h"

#include <vector>

#include "core/error.h"
#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/pattern/sheet_text.h"

namespace geoprior::sketch {
namespace {

constexpr double kPointsOfMillimetre = 72 / 25.4;

std::string pdf_point(const Eigen::Vector2d& p) {
  return written_number(p.x()) + " " + written_number(p.y()) + " ";
}

/// The operator after which a page counts in millimetres.
std::string in_millimetres() {
  const std::string scale = written_number(kPointsOfMillimetre, 12);
  return scale + " 0 0 " + scale + " 0 0 cm\n";
}

/// The operators that draw one page, in millimetres.
class PdfPageWriter {
 public:
  PdfPageWriter(const PatternSheet& sheet, const SheetPage& page, const LayerStyle& style)
      : sheet_(sheet), page_(page), style_(style) {}

  std::string write() {
    out_ = in_millimetres() + "1 j 1 J " + written_number(style_.line_mm) + " w\n";
    out_ += "q\n" + pdf_point(page_.place) + pdf_point(page_.window.sizes()) + "re W n\n";
    for (const SheetLayer layer : used_layers(sheet_)) write_layer(layer);
    out_ += "Q\n";
    set_colour(SheetLayer::text);
    for (const SheetLine& mark : page_.marks) write_path(mark, {0, 0});
    for (const SheetText& text : page_.texts) write_text(text.at, text);
    return std::move(out_);
  }

 private:
  void set_colour(SheetLayer layer) {
    for (const char* op : {"RG ", "rg\n"}) {
      for (const double x : layer_rgb(style_, layer)) out_ += written_number(x, 4) + " ";
      out_ += op;
    }
    out_ += layer == SheetLayer::fold || layer == SheetLayer::place ? "[4 2] 0 d\n" : "[] 0 d\n";
  }

  void write_layer(SheetLayer layer) {
    set_colour(layer);
    for (const SheetPiece& piece : sheet_.pieces) {
      const Eigen::AlignedBox2d box(piece.place, Eigen::Vector2d(piece.place + piece.size));
      if (!box.intersects(page_.window)) continue;
      for (const SheetLine& line : piece.lines) {
        if (line.layer == layer) write_path(line, piece.place);
      }
      if (layer != SheetLayer::text) continue;
      for (const SheetText& text : piece.texts) {
        write_text(page_.on_page(text.at + piece.place), text);
      }
    }
    for (const SheetLine& line : sheet_.lines) {
      if (line.layer == layer) write_path(line, {0, 0});
    }
    if (layer != SheetLayer::text) return;
    for (const SheetText& text : sheet_.texts) write_text(page_.on_page(text.at), text);
  }

  void write_path(const SheetLine& line, const Eigen::Vector2d& place) {
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      out_ += pdf_point(page_.on_page(line.points[i] + place)) + (i == 0 ? "m\n" : "l\n");
    }
    out_ += line.closed ? "s\n" : "S\n";
  }

  void write_text(const Eigen::Vector2d& at, const SheetText& text) {
    const double before = text.anchor == TextAnchor::middle ? helvetica_width(text.text) / 2 : 0;
    const Eigen::Vector2d left(-before, -kCapitalMiddle);
    out_ += "BT /F1 " + written_number(text.height) + " Tf " + pdf_point(at + text.height * left) +
            "Td " + pdf_text(text.text) + " Tj ET\n";
  }

  const PatternSheet& sheet_;
  const SheetPage& page_;
  const LayerStyle& style_;
  std::string out_;
};

/// Numbered objects one after the other, and where each begins.
class PdfFile {
 public:
  /// Objects come in the order of their numbers, from 1 on.
  void object(const std::string& body) {
    offsets_.push_back(out_.size());
    out_ += std::to_string(offsets_.size()) + " 0 obj\n" + body + "\nendobj\n";
  }
  void stream(const std::string& content) {
    object("<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content +
           "\nendstream");
  }

  /// Closes the file: the table of objects has lines of 20 bytes.
  std::string finish(int root, int info) {
    const std::size_t table = out_.size();
    const std::string count = std::to_string(offsets_.size() + 1);
    out_ += "xref\n0 " + count + "\n0000000000 65535 f \n";
    for (const std::size_t offset : offsets_) {
      const std::string digits = std::to_string(offset);
      out_ += std::string(10 - digits.size(), '0') + digits + " 00000 n \n";
    }
    out_ += "trailer\n<< /Size " + count + " /Root " + std::to_string(root) + " 0 R /Info " +
            std::to_string(info) + " 0 R >>\nstartxref\n" + std::to_string(table) + "\n%%EOF\n";
    return std::move(out_);
  }

 private:
  // The comment's bytes say that the file is not to be sent as text.
  std::string out_ = "%PDF-1.4\n%\xE2\xE3\xCF\xD3\n";
  std::vector<std::size_t> offsets_;
};

}  // namespace

std::string pdf_document(const PatternSheet& sheet, std::span<const SheetPage> pages,
                         const LayerStyle& style, std::span<const PdfExtraPage> more) {
  if (pages.empty()) throw Error("no page", "PDF", "one or more");
  PdfFile file;
  // 1 catalogue, 2 pages, 3 font, 4 information, then a page and its contents in turn.
  file.object("<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>");
  const std::size_t count = pages.size() + more.size();
  std::string kids;
  for (std::size_t i = 0; i < count; ++i) kids += std::to_string(5 + 2 * i) + " 0 R ";
  file.object("<< /Type /Pages /Kids [ " + kids + "] /Count " + std::to_string(count) + " >>");
  file.object("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>");
  file.object("<< /Title " + pdf_utf16_text(sheet.title) + " >>");
  std::size_t number = 6;
  const auto add = [&](const Eigen::Vector2d& paper, const std::string& content) {
    file.object(
        "<< /Type /Page /Parent 2 0 R /MediaBox [ 0 0 " + pdf_point(kPointsOfMillimetre * paper) +
        "] /Resources << /Font << /F1 3 0 R >> >> /Contents " + std::to_string(number) + " 0 R >>");
    file.stream(content);
    number += 2;
  };
  for (const SheetPage& page : pages) add(page.paper, PdfPageWriter(sheet, page, style).write());
  for (const PdfExtraPage& page : more) add(page.size, in_millimetres() + page.content);
  return file.finish(1, 4);
}

}  // namespace geoprior::sketch
