#include "experiments/sketch/fabrication/strain_page.h"

#include <cmath>
#include <cstdint>

#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/layer_style.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/pattern/sheet_text.h"
#include "testbed/formats/svg/color.h"

namespace geoprior::sketch {
namespace {

constexpr int kStrainDecimals = 2;      ///< of coordinates (mm)
constexpr double kStrainOutline = 0.3;  ///< width of lines (mm)
constexpr double kStrainCut = 1;        ///< width of suggested cuts (mm)
/// Width of the line around each triangle, in its colour, so that no gap shows between two (mm).
constexpr double kStrainOverlap = 0.15;

std::string strain_number(double x) { return written_number(x, kStrainDecimals); }

std::string strain_hex(const Eigen::Vector3d& colour) {
  const auto channel = [&](int k) {
    return static_cast<std::uint8_t>(std::lround(255 * colour(k)));
  };
  return to_text(SvgColour{channel(0), channel(1), channel(2)});
}

class StrainSvg {
 public:
  explicit StrainSvg(const StrainSheet& sheet) : sheet_(sheet) {}

  std::string write() {
    const std::string w = strain_number(sheet_.size.x()), h = strain_number(sheet_.size.y());
    out_ =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "version=\"1.1\" width=\"" +
        w + "mm\" height=\"" + h + "mm\" viewBox=\"0 0 " + w + " " + h +
        "\" stroke-linejoin=\"round\">\n<rect width=\"" + w + "\" height=\"" + h +
        "\" fill=\"#ffffff\"/>\n";
    for (const StrainPatch& patch : sheet_.patches) write_patch(patch);
    write_lines("outlines", sheet_.outlines, kStrainOutline, "");
    write_lines("added", sheet_.added, kStrainCut,
                " stroke-dasharray=\"" + strain_number(6 * sheet_.unit) + " " +
                    strain_number(3 * sheet_.unit) + "\"");
    write_lines("worst", sheet_.worst, 2 * kStrainOutline, "");
    for (const SheetText& text : sheet_.texts) write_text(text);
    return std::move(out_) + "</svg>\n";
  }

 private:
  std::string point(const Eigen::Vector2d& p) const {
    return strain_number(p.x()) + " " + strain_number(sheet_.size.y() - p.y());
  }

  void write_patch(const StrainPatch& patch) {
    const std::string colour = strain_hex(patch.colour);
    out_ += "<path class=\"strain\" fill=\"" + colour + "\" stroke=\"" + colour +
            "\" stroke-width=\"" + strain_number(kStrainOverlap) + "\" d=\"";
    for (const auto& [a, b, c] : patch.triangles)
      out_ += "M" + point(a) + "L" + point(b) + "L" + point(c) + "Z";
    out_ += "\"/>\n";
  }

  void write_lines(const std::string& name, const std::vector<SheetLine>& lines, double width,
                   const std::string& dashes) {
    out_ += "<g id=\"" + name + "\" fill=\"none\" stroke=\"#000000\" stroke-width=\"" +
            strain_number(sheet_.unit * width) + "\"" + dashes + ">\n";
    for (const SheetLine& line : lines) {
      out_ += "<path d=\"";
      for (std::size_t i = 0; i < line.points.size(); ++i)
        out_ += (i == 0 ? "M" : "L") + point(line.points[i]);
      out_ += line.closed ? "Z\"/>\n" : "\"/>\n";
    }
    out_ += "</g>\n";
  }

  void write_text(const SheetText& text) {
    const Eigen::Vector2d base = text.at - Eigen::Vector2d(0, kCapitalMiddle * text.height);
    out_ += "<text x=\"" + strain_number(base.x()) + "\" y=\"" +
            strain_number(sheet_.size.y() - base.y()) +
            "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"" +
            strain_number(text.height) + "\" text-anchor=\"" +
            (text.anchor == TextAnchor::middle ? "middle" : "start") + "\">" + xml_text(text.text) +
            "</text>\n";
  }

  const StrainSheet& sheet_;
  std::string out_;
};

class StrainPdf {
 public:
  explicit StrainPdf(const StrainSheet& sheet) : sheet_(sheet) {}

  PdfExtraPage write() {
    out_ = "1 j 1 J\n";
    for (const StrainPatch& patch : sheet_.patches) write_patch(patch);
    write_lines(sheet_.outlines, kStrainOutline, "[] 0 d\n");
    write_lines(
        sheet_.added, kStrainCut,
        "[" + strain_number(6 * sheet_.unit) + " " + strain_number(3 * sheet_.unit) + "] 0 d\n");
    write_lines(sheet_.worst, 2 * kStrainOutline, "[] 0 d\n");
    for (const SheetText& text : sheet_.texts) {
      const double before = text.anchor == TextAnchor::middle ? helvetica_width(text.text) / 2 : 0;
      const Eigen::Vector2d left(-before, -kCapitalMiddle);
      out_ += "BT /F1 " + strain_number(text.height) + " Tf " +
              point(text.at + text.height * left) + "Td " + pdf_text(text.text) + " Tj ET\n";
    }
    return {sheet_.size, std::move(out_)};
  }

 private:
  static std::string point(const Eigen::Vector2d& p) {
    return strain_number(p.x()) + " " + strain_number(p.y()) + " ";
  }

  void set_colours(const Eigen::Vector3d& colour) {
    for (const char* op : {"RG ", "rg\n"}) {
      for (const double x : colour) out_ += written_number(x, 3) + " ";
      out_ += op;
    }
  }

  void write_patch(const StrainPatch& patch) {
    set_colours(patch.colour);
    out_ += strain_number(kStrainOverlap) + " w\n";
    for (const auto& [a, b, c] : patch.triangles)
      out_ += point(a) + "m " + point(b) + "l " + point(c) + "l b\n";
  }

  void write_lines(const std::vector<SheetLine>& lines, double width, const std::string& dashes) {
    set_colours({0, 0, 0});
    out_ += strain_number(sheet_.unit * width) + " w " + dashes;
    for (const SheetLine& line : lines) {
      for (std::size_t i = 0; i < line.points.size(); ++i)
        out_ += point(line.points[i]) + (i == 0 ? "m\n" : "l\n");
      out_ += line.closed ? "s\n" : "S\n";
    }
  }

  const StrainSheet& sheet_;
  std::string out_;
};

}  // namespace

std::string strain_svg(const StrainSheet& sheet) { return StrainSvg(sheet).write(); }

PdfExtraPage strain_pdf_page(const StrainSheet& sheet) { return StrainPdf(sheet).write(); }

}  // namespace geoprior::sketch
