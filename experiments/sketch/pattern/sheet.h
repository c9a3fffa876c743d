#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/options.h"
#include "models/sketch/surface/positive_winding.h"

namespace geoprior::sketch {

/// What is done along a line of a pattern sheet.
enum class SheetLayer {
  cut,
  sew,
  fold,
  notch,
  grain,
  text,
  drill,  ///< round holes
  place,  ///< where the edge of another piece lies
};

inline constexpr std::array<SheetLayer, 8> kSheetLayers{
    SheetLayer::cut,   SheetLayer::sew,  SheetLayer::fold,  SheetLayer::notch,
    SheetLayer::grain, SheetLayer::text, SheetLayer::drill, SheetLayer::place};

/// Name as it is written in files: "cut", …
std::string_view layer_name(SheetLayer layer);

/// How a pattern is laid out for cutting. Millimetres.
struct SheetOptions {
  double allowance_mm = 7;
  double hem_mm = 7;
  double miter_limit = 2.5;
  double notch_spacing_mm = 80;
  double notch_length_mm = 4;  ///< of the tick, from the cutting line inwards
  double text_mm = 6;          ///< height of pieces' names, less where there is no room
  double gap_mm = 10;
  double width_mm = 0;  ///< of the sheet at least; 0: about as wide as high
  std::string title = "Pattern";
};

/// One description for parsing, validation and help.
void describe(OptionVisitor& v, SheetOptions& options);

/// A drawn line. Millimetres.
struct SheetLine {
  SheetLayer layer = SheetLayer::cut;
  bool closed = false;
  PlaneLoop points;
  int number = 0;  ///< of its border (outer 0, holes from 1), its fold, drilled hole or placement
                   ///< from 0, its notch from 1
};

enum class TextAnchor { middle, left };

/// One line of text. Millimetres.
struct SheetText {
  Eigen::Vector2d at{0, 0};  ///< middle of the text, or of its left end
  double height = 5;         ///< size of the font
  std::u32string text;       ///< without control characters (sheet_text.h)
  TextAnchor anchor = TextAnchor::middle;
};

/// Where a notch is cut. Millimetres, in the piece's own coordinates.
struct SheetNotch {
  int label = 0;
  bool direction = false;      ///< drawn as two ticks
  Eigen::Vector2d sewn{0, 0};  ///< on the sewing line
  Eigen::Vector2d cut{0, 0};   ///< on the cutting line, straight outside
  double arc = 0;              ///< along its edge, from the edge's first point
  int piece = 0, edge = 0;
};

/// One piece, in its own coordinates: millimetres, grain upwards, lower left corner of its box at
/// the origin.
struct SheetPiece {
  std::string name;              ///< as the pattern has it: any bytes
  std::u32string label;          ///< its name, fit to be written
  std::vector<SheetLine> lines;  ///< by layer: cut and sew closed, the outer loop first
  std::vector<SheetText> texts;
  std::vector<SheetNotch> notches;
  Eigen::Vector2d size{0, 0};                          ///< of the box around everything
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();  ///< of the pattern (m): own coordinates …
  Eigen::Vector2d shift{0, 0};                         ///< … are 1000 turn · p + shift
  Eigen::Vector2d place{0, 0};                         ///< of its origin on the sheet
  std::u32string verdict = {};  ///< written below the name (piece_verdict.h); none when empty
  bool refused = false;         ///< it is not to be cut: nothing of it is drawn

  /// A point of the pattern (m) in the piece's own coordinates (mm).
  [[nodiscard]] Eigen::Vector2d own(const Eigen::Vector2d& p) const {
    return 1000 * (turn * p) + shift;
  }
};

/// A whole pattern at true scale, right and up in millimetres from the lower left corner: what
/// every file format writes.
struct PatternSheet {
  std::u32string title;
  Eigen::Vector2d size{0, 0};
  std::vector<SheetPiece> pieces;
  std::vector<SheetLine> lines;  ///< beside the pieces: the scale bar (layer text)
  std::vector<SheetText> texts;
};

/// The layers that a file of the sheet has: holes and placements only where there are some.
std::vector<SheetLayer> used_layers(const PatternSheet& sheet);

/// Length of the scale bar (mm).
inline constexpr double kScaleBar = 100;

}  // namespace geoprior::sketch
