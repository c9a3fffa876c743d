#include "experiments/sketch/fabrication/pattern_svg.h"

#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/written_number.h"

namespace geoprior::sketch {
namespace {

/// Writes one page; coordinates are turned to SVG's.
class SvgPageWriter {
 public:
  SvgPageWriter(const PatternSheet& sheet, const SheetPage& page, const LayerStyle& style)
      : sheet_(sheet), page_(page), style_(style) {}

  std::string write() {
    open();
    const bool clipped = !page_.label.empty();
    for (const SheetLayer layer : used_layers(sheet_)) {
      layer_rgb(style_, layer);
      const std::string name(layer_name(layer));
      out_ += "<g id=\"" + name + "\" inkscape:groupmode=\"layer\" inkscape:label=\"" + name +
              "\" fill=\"none\" stroke=\"" + style_.colour(layer) + "\" stroke-width=\"" +
              written_number(style_.line_mm) + "\"" +
              (layer == SheetLayer::fold || layer == SheetLayer::place ? " stroke-dasharray=\"4 2\""
                                                                       : "") +
              ">\n";
      if (clipped) out_ += "<g clip-path=\"url(#page)\">\n";
      write_layer(layer);
      if (clipped) out_ += "</g>\n";
      if (layer == SheetLayer::text) write_marks();
      out_ += "</g>\n";
    }
    return std::move(out_) + "</svg>\n";
  }

 private:
  void open() {
    const std::string w = written_number(page_.paper.x()), h = written_number(page_.paper.y());
    out_ =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" "
        "width=\"" +
        w + "mm\" height=\"" + h + "mm\" viewBox=\"0 0 " + w + " " + h + "\">\n";
    out_ += "<title>" + xml_text(sheet_.title) + "</title>\n";
    if (page_.label.empty()) return;
    const Eigen::Vector2d size = page_.window.sizes();
    out_ += "<clipPath id=\"page\"><rect x=\"" + written_number(page_.place.x()) + "\" y=\"" +
            written_number(page_.paper.y() - page_.place.y() - size.y()) + "\" width=\"" +
            written_number(size.x()) + "\" height=\"" + written_number(size.y()) +
            "\"/></clipPath>\n";
  }

  void write_layer(SheetLayer layer) {
    for (std::size_t k = 0; k < sheet_.pieces.size(); ++k) {
      const SheetPiece& piece = sheet_.pieces[k];
      const Eigen::AlignedBox2d box(piece.place, Eigen::Vector2d(piece.place + piece.size));
      if (!box.intersects(page_.window)) continue;
      const std::string of =
          " data-piece=\"" + std::to_string(k) + "\" data-name=\"" + xml_text(piece.label) + "\"";
      for (const SheetLine& line : piece.lines) {
        if (line.layer == layer) write_path(line, piece.place, of + number_of(line));
      }
      if (layer != SheetLayer::text) continue;
      for (const SheetText& text : piece.texts) {
        write_text(page_.on_page(text.at + piece.place), text, of);
      }
    }
    for (const SheetLine& line : sheet_.lines) {
      if (line.layer == layer) write_path(line, {0, 0}, " class=\"scale-bar\"");
    }
    if (layer != SheetLayer::text) return;
    for (const SheetText& text : sheet_.texts) write_text(page_.on_page(text.at), text, "");
  }

  static std::string number_of(const SheetLine& line) {
    const std::string number = "=\"" + std::to_string(line.number) + "\"";
    switch (line.layer) {
      case SheetLayer::cut:
      case SheetLayer::sew:
        return " data-border" + number;
      case SheetLayer::fold:
        return " data-fold" + number;
      case SheetLayer::notch:
        return " data-notch" + number;
      case SheetLayer::drill:
        return " data-hole" + number;
      case SheetLayer::place:
        return " data-place" + number;
      default:
        return "";
    }
  }

  void write_marks() {
    for (const SheetLine& mark : page_.marks) write_path(mark, {0, 0}, " class=\"mark\"");
    for (const SheetText& text : page_.texts) write_text(text.at, text, "");
  }

  void write_path(const SheetLine& line, const Eigen::Vector2d& place,
                  const std::string& attributes) {
    out_ += "<path" + attributes + " d=\"";
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const Eigen::Vector2d p = page_.on_page(line.points[i] + place);
      out_ += i == 0 ? "M" : "L";
      out_ += written_number(p.x()) + " " + written_number(page_.paper.y() - p.y());
    }
    out_ += line.closed ? "Z\"/>\n" : "\"/>\n";
  }

  void write_text(const Eigen::Vector2d& at, const SheetText& text, const std::string& attributes) {
    const double base = page_.paper.y() - at.y() + kCapitalMiddle * text.height;
    out_ += "<text" + attributes + " x=\"" + written_number(at.x()) + "\" y=\"" +
            written_number(base) + "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"" +
            written_number(text.height) + "\" text-anchor=\"" +
            (text.anchor == TextAnchor::middle ? "middle" : "start") +
            "\" stroke=\"none\" fill=\"" + style_.colour(SheetLayer::text) + "\">" +
            xml_text(text.text) + "</text>\n";
  }

  const PatternSheet& sheet_;
  const SheetPage& page_;
  const LayerStyle& style_;
  std::string out_;
};

}  // namespace

std::string svg_page(const PatternSheet& sheet, const SheetPage& page, const LayerStyle& style) {
  return SvgPageWriter(sheet, page, style).write();
}

}  // namespace geoprior::sketch
