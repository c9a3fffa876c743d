#include "experiments/sketch/fabrication/pattern_map.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/pattern/sheet_text.h"
#include "models/sketch/pattern/piece_border.h"

namespace geoprior::sketch {
namespace {

using PatternJson = nlohmann::ordered_json;

PatternJson json_point(const Eigen::Vector2d& p) { return PatternJson::array({p.x(), p.y()}); }

PatternJson json_edges(const PatternPiece& piece) {
  PatternJson edges = PatternJson::array();
  for (const PieceEdge& edge : piece.edges) {
    PatternJson one{{"points", edge.vertices}, {"length_mm", 1000 * edge_length(piece, edge)}};
    if (edge.partner_piece >= 0) {
      one["seam"] = edge.seam;
      one["sewn_to"] = {{"piece", edge.partner_piece}, {"edge", edge.partner_edge}};
    }
    edges.push_back(std::move(one));
  }
  return edges;
}

PatternJson json_notches(const SheetPiece& drawn) {
  PatternJson notches = PatternJson::array();
  for (const SheetNotch& notch : drawn.notches) {
    notches.push_back({{"pair", notch.label},
                       {"direction", notch.direction},
                       {"edge", notch.edge},
                       {"arc_mm", 1000 * notch.arc}});
  }
  return notches;
}

/// In quotes, as RFC 4180 has them; on one line, whatever the name holds.
std::string csv_field(const std::string& name) {
  std::string field = "\"";
  for (const char c : utf8_text(label_text(name, 80))) {
    field += c;
    if (c == '"') field += c;
  }
  return field + "\"";
}

PatternJson json_piece(const PatternPiece& piece, const SheetPiece& drawn) {
  PatternJson points = PatternJson::array();
  for (Eigen::Index i = 0; i < piece.points.rows(); ++i) {
    points.push_back(json_point(1000 * piece.points.row(i).transpose()));
  }
  PatternJson holes = PatternJson::array();
  for (const PieceHole& hole : piece.holes) {
    holes.push_back(
        {{"centre_mm", json_point(1000 * hole.centre)}, {"radius_mm", 1000 * hole.radius}});
  }
  const Eigen::Vector2d right = drawn.turn.row(0).transpose(), up = drawn.turn.row(1).transpose();
  PatternJson result{{"name", piece.name},
                     {"points_mm", std::move(points)},
                     {"surface_vertex", piece.surface_vertex},
                     {"borders", piece.borders},
                     {"edges", json_edges(piece)},
                     {"folds", piece.folds},
                     {"notches", json_notches(drawn)},
                     {"grain", json_point(piece.grain)},
                     {"sheet",
                      {{"right", json_point(right)},
                       {"up", json_point(up)},
                       {"origin_mm", json_point(drawn.shift + drawn.place)}}}};
  if (drawn.refused) result["refused"] = true;
  if (!piece.holes.empty()) result["holes"] = std::move(holes);
  return result;
}

void require_map(const Pattern& pattern, const PatternSheet& sheet) {
  if (pattern.pieces.size() != sheet.pieces.size()) {
    throw Error("the sheet has " + std::to_string(sheet.pieces.size()) + " pieces", "pattern map",
                std::to_string(pattern.pieces.size()));
  }
  for (int k = 0; k < std::ssize(pattern.pieces); ++k) {
    const PatternPiece& piece = pattern.pieces[k];
    const Eigen::Index given = piece.surface_vertex.size();
    if (given != piece.points.rows()) {
      throw Error("has surface vertices for " + std::to_string(given) + " points",
                  piece_label(pattern, k), std::to_string(piece.points.rows()));
    }
  }
}

}  // namespace

std::string pattern_map_csv(const Pattern& pattern, const PatternSheet& sheet) {
  require_map(pattern, sheet);
  std::string out = "piece,point,surface_vertex,x_mm,y_mm,sheet_x_mm,sheet_y_mm,name\n";
  for (std::size_t k = 0; k < pattern.pieces.size(); ++k) {
    const PatternPiece& piece = pattern.pieces[k];
    if (sheet.pieces[k].refused) continue;
    const std::string name = csv_field(piece.name);
    for (Eigen::Index i = 0; i < piece.points.rows(); ++i) {
      const Eigen::Vector2d p = piece.points.row(i).transpose();
      const Eigen::Vector2d on_sheet = sheet.pieces[k].own(p) + sheet.pieces[k].place;
      out += std::to_string(k) + "," + std::to_string(i) + "," +
             std::to_string(piece.surface_vertex[i]);
      for (const double x : {1000 * p.x(), 1000 * p.y(), on_sheet.x(), on_sheet.y()}) {
        out.append(",").append(written_number(x));
      }
      out.append(",").append(name).append("\n");
    }
  }
  return out;
}

std::string pattern_json(const Pattern& pattern, const PatternSheet& sheet) {
  require_map(pattern, sheet);
  PatternJson pieces = PatternJson::array();
  for (std::size_t k = 0; k < pattern.pieces.size(); ++k) {
    pieces.push_back(json_piece(pattern.pieces[k], sheet.pieces[k]));
  }
  const PatternJson root{{"format", "geoprior pattern"},
                         {"version", 1},
                         {"unit", "mm"},
                         {"sheet_mm", json_point(sheet.size)},
                         {"pieces", std::move(pieces)}};
  return root.dump(1, ' ', false, PatternJson::error_handler_t::replace) + "\n";
}

}  // namespace geoprior::sketch
