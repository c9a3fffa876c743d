#include "experiments/sketch/fabrication/pattern_dxf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/geometry/planar.h"
#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/layer_style.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/pattern/sheet_text.h"

namespace geoprior::sketch {
namespace {

constexpr double kTurnAngle = 20 * std::numbers::pi / 180;  // a sharper bend is a turn point
constexpr double kSystemText = 2;                           // height (mm)

/// Number and AutoCAD's colour of each layer.
constexpr std::array<std::pair<const char*, int>, 9> kDxfLayers{
    {{"1", 7}, {"2", 8}, {"3", 9}, {"4", 6}, {"7", 3}, {"8", 4}, {"11", 1}, {"14", 5}, {"15", 2}}};

/// Pairs of group code and value, one a line.
class DxfWriter {
 public:
  void tag(int code, const std::string& value) {
    out_ += std::to_string(code) + "\n" + value + "\n";
  }
  void tag(int code, int value) { tag(code, std::to_string(value)); }
  void number(int code, double value) { tag(code, written_number(value, 6)); }
  void point(int code, const Eigen::Vector2d& p) {
    number(code, p.x());
    number(code + 10, p.y());
    number(code + 20, 0);
  }
  void entity(const std::string& kind, const std::string& layer) {
    tag(0, kind);
    tag(8, layer);
  }
  void begin_section(const std::string& name) {
    tag(0, "SECTION");
    tag(2, name);
  }
  void begin_table(const std::string& name, int count) {
    tag(0, "TABLE");
    tag(2, name);
    tag(70, count);
  }

  void mark(const std::string& layer, const Eigen::Vector2d& p) {
    entity("POINT", layer);
    point(10, p);
  }

  /// A LINE for two points, a POLYLINE for more.
  void line(const std::string& layer, const SheetLine& line) {
    if (!line.closed && line.points.size() == 2) {
      entity("LINE", layer);
      point(10, line.points[0]);
      point(11, line.points[1]);
      return;
    }
    entity("POLYLINE", layer);
    tag(66, 1);
    point(10, {0, 0});
    tag(70, line.closed ? 1 : 0);
    for (const Eigen::Vector2d& p : line.points) {
      entity("VERTEX", layer);
      point(10, p);
    }
    entity("SEQEND", layer);
  }

  /// Text whose base line begins at `left`.
  void text(const std::string& layer, const Eigen::Vector2d& left, double height,
            const std::string& value) {
    entity("TEXT", layer);
    point(10, left);
    number(40, height);
    tag(1, value);
  }

  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

void write_dxf_header(const PatternSheet& sheet, DxfWriter& out) {
  out.begin_section("HEADER");
  const auto variable = [&](const std::string& name) { out.tag(9, name); };
  variable("$ACADVER");
  out.tag(1, "AC1009");
  variable("$DWGCODEPAGE");
  out.tag(3, "ANSI_1252");
  variable("$INSBASE");
  out.point(10, {0, 0});
  variable("$EXTMIN");
  out.point(10, {0, 0});
  variable("$EXTMAX");
  out.point(10, sheet.size);
  variable("$MEASUREMENT");
  out.tag(70, 1);
  variable("$INSUNITS");
  out.tag(70, 4);
  out.tag(0, "ENDSEC");
}

void write_dxf_tables(const PatternSheet& sheet, DxfWriter& out) {
  out.begin_section("TABLES");
  out.begin_table("LTYPE", 1);
  out.tag(0, "LTYPE");
  out.tag(2, "CONTINUOUS");
  out.tag(70, 0);
  out.tag(3, "Solid line");
  out.tag(72, 65);
  out.tag(73, 0);
  out.number(40, 0);
  out.tag(0, "ENDTAB");
  const std::vector<SheetLayer> used = used_layers(sheet);
  const bool drilled = std::find(used.begin(), used.end(), SheetLayer::drill) != used.end();
  out.begin_table("LAYER", static_cast<int>(kDxfLayers.size()) + (drilled ? 2 : 1));
  const auto layer = [&](const std::string& name, int colour) {
    out.tag(0, "LAYER");
    out.tag(2, name);
    out.tag(70, 0);
    out.tag(62, colour);
    out.tag(6, "CONTINUOUS");
  };
  layer("0", 7);
  for (const auto& [name, colour] : kDxfLayers) layer(name, colour);
  if (drilled) layer("13", 30);
  out.tag(0, "ENDTAB");
  out.begin_table("STYLE", 1);
  out.tag(0, "STYLE");
  out.tag(2, "STANDARD");
  out.tag(70, 0);
  out.number(40, 0);
  out.number(41, 1);
  out.number(50, 0);
  out.tag(71, 0);
  out.number(42, 2.5);
  out.tag(3, "txt");
  out.tag(4, "");
  out.tag(0, "ENDTAB");
  out.tag(0, "ENDSEC");
}

/// Cutting line, the points that say which of its corners are corners, and holes.
void write_dxf_cut(const SheetLine& line, DxfWriter& out) {
  out.line(line.number == 0 ? "1" : "11", line);
  const std::size_t n = line.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& p = line.points[i];
    const double turn =
        signed_angle(p - line.points[(i + n - 1) % n], line.points[(i + 1) % n] - p);
    out.mark(std::abs(turn) > kTurnAngle ? "2" : "3", p);
  }
}

/// A hole is drilled where the point says; how wide is the tool's.
Eigen::Vector2d middle_of(const SheetLine& line) {
  Eigen::Vector2d sum(0, 0);
  for (const Eigen::Vector2d& p : line.points) sum += p;
  return sum / static_cast<double>(line.points.size());
}

void write_dxf_line(const SheetLine& line, DxfWriter& out) {
  switch (line.layer) {
    case SheetLayer::cut:
      return write_dxf_cut(line, out);
    case SheetLayer::sew:
      return out.line("14", line);
    case SheetLayer::fold:
    case SheetLayer::notch:
    case SheetLayer::place:
      return out.line("8", line);
    case SheetLayer::drill:
      return out.mark("13", middle_of(line));
    case SheetLayer::grain:
      // The arrow's head is for people: the format wants one line.
      if (line.points.size() == 2) out.line("7", line);
      return;
    case SheetLayer::text:
      return out.line("15", line);
  }
}

void write_dxf_label(const SheetText& text, DxfWriter& out) {
  const double before = text.anchor == TextAnchor::middle ? helvetica_width(text.text) / 2 : 0;
  const Eigen::Vector2d to_left(-before, -kCapitalMiddle);
  // The size of a font is larger than its capitals, which DXF measures.
  out.text("15", text.at + text.height * to_left, 2 * kCapitalMiddle * text.height,
           dxf_text(text.text));
}

void write_dxf_block(const SheetPiece& piece, const std::string& name, DxfWriter& out) {
  out.entity("BLOCK", "1");
  out.tag(2, name);
  out.tag(70, 0);
  out.point(10, {0, 0});
  out.tag(3, name);
  for (const SheetLine& line : piece.lines) write_dxf_line(line, out);
  for (const SheetNotch& notch : piece.notches) out.mark("4", notch.cut);
  std::vector<std::string> system{"PIECE NAME: " + dxf_text(piece.label), "SIZE: ONE",
                                  "QUANTITY: 1"};
  if (!piece.verdict.empty()) system.push_back("ANNOTATION: " + dxf_text(piece.verdict));
  for (std::size_t i = 0; i < system.size(); ++i) {
    const double below = -1.5 * kSystemText * static_cast<double>(i + 1);
    out.text("1", {0, below}, kSystemText, system[i]);
  }
  for (const SheetText& text : piece.texts) write_dxf_label(text, out);
  out.entity("ENDBLK", "1");
}

}  // namespace

std::string dxf_drawing(const PatternSheet& sheet) {
  DxfWriter out;
  write_dxf_header(sheet, out);
  write_dxf_tables(sheet, out);
  out.begin_section("BLOCKS");
  for (std::size_t k = 0; k < sheet.pieces.size(); ++k) {
    if (sheet.pieces[k].refused) continue;
    write_dxf_block(sheet.pieces[k], dxf_block_name(k + 1, sheet.pieces[k].label), out);
  }
  out.tag(0, "ENDSEC");
  out.begin_section("ENTITIES");
  for (std::size_t k = 0; k < sheet.pieces.size(); ++k) {
    if (sheet.pieces[k].refused) continue;
    out.entity("INSERT", "1");
    out.tag(2, dxf_block_name(k + 1, sheet.pieces[k].label));
    out.point(10, sheet.pieces[k].place);
  }
  out.text("1", {0, -4}, kSystemText, "STYLE NAME: " + dxf_text(sheet.title));
  out.text("1", {0, -8}, kSystemText, "UNITS: METRIC");
  for (const SheetLine& line : sheet.lines) write_dxf_line(line, out);
  for (const SheetText& text : sheet.texts) write_dxf_label(text, out);
  out.tag(0, "ENDSEC");
  out.tag(0, "EOF");
  return out.take();
}

}  // namespace geoprior::sketch
