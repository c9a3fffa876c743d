#include "solvers/paper/hybrid_frame.h"

#include <utility>

#include "models/paper/sheet/pattern.h"

namespace geoprior::paper {
namespace {

double kind_number(const PaperStructure& structure, int piece) {
  return piece < 0 ? 0 : static_cast<double>(structure.pieces[piece].kind);
}

Part rulings_part(const PaperStructure& structure, const RulingMesh& mesh,
                  const ShellState& state) {
  Part part;
  part.kind = Part::Kind::lines;
  const Eigen::Index count = mesh.ruling_paths.size();
  Eigen::MatrixXd piece(count, 1), kind(count, 1);
  std::size_t points = 0;
  for (const auto& path : mesh.ruling_paths) points += path.size();
  part.points.resize(points, 3);
  int next = 0;
  for (Eigen::Index r = 0; r < count; ++r) {
    std::vector<int> line;
    for (const int v : mesh.ruling_paths[r]) {
      part.points.row(next) = state.x.row(v);
      line.push_back(next++);
    }
    part.lines.push_back(std::move(line));
    piece(r, 0) = structure.rulings[r].piece;
    kind(r, 0) = kind_number(structure, structure.rulings[r].piece);
  }
  part.arrays.push_back({"piece", "1", NamedArray::On::cells, piece});
  part.arrays.push_back({"kind", "1", NamedArray::On::cells, kind});
  return part;
}

Part points_part(const PaperStructure& structure, const RulingMesh& mesh, const ShellState& state) {
  Part part;
  part.kind = Part::Kind::points;
  const Eigen::Index count = structure.singular_points.size();
  part.points.resize(count, 3);
  Eigen::MatrixXd id(count, 1), birth(count, 1), weakening(count, 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SingularPoint& s = structure.singular_points[i];
    part.points.row(i) = state.x.row(mesh.singular_vertices[i]);
    id(i, 0) = s.id;
    birth(i, 0) = s.birth;
    weakening(i, 0) = s.weakening;
  }
  part.arrays.push_back({"id", "1", NamedArray::On::points, id});
  part.arrays.push_back({"birth", "s", NamedArray::On::points, birth});
  part.arrays.push_back({"weakening", "1", NamedArray::On::points, weakening});
  return part;
}

FrameTable pieces_table(const PaperStructure& structure) {
  FrameTable table;
  table.columns = {"id [1]",         "kind [1]",          "rulings [1]",     "apex_u [m]",
                   "apex_v [m]",     "direction_u [1]",   "direction_v [1]", "area [m^2]",
                   "neighbours [1]", "singular_point [1]"};
  table.rows.setZero(structure.pieces.size(), table.columns.size());
  for (std::size_t i = 0; i < structure.pieces.size(); ++i) {
    const PaperPiece& p = structure.pieces[i];
    const Eigen::Vector2d apex = p.apex.value_or(Eigen::Vector2d::Zero());
    const bool cylinder = p.kind == PaperPiece::Kind::cylinder;
    table.rows.row(i) << p.id, static_cast<double>(p.kind), static_cast<double>(p.rulings.size()),
        apex.x(), apex.y(), cylinder ? p.direction.x() : 0, cylinder ? p.direction.y() : 0,
        signed_area(p.region), static_cast<double>(p.neighbours.size()),
        p.singular_point.value_or(-1);
  }
  return table;
}

FrameTable points_table(const PaperStructure& structure) {
  FrameTable table;
  table.columns = {"id [1]", "u [m]", "v [m]", "birth [s]", "weakening [1]", "on_border [1]"};
  table.rows.resize(structure.singular_points.size(), table.columns.size());
  for (std::size_t i = 0; i < structure.singular_points.size(); ++i) {
    const SingularPoint& s = structure.singular_points[i];
    table.rows.row(i) << s.id, s.position.x(), s.position.y(), s.birth, s.weakening,
        s.on_border ? 1 : 0;
  }
  return table;
}

}  // namespace

void add_structure(const PaperStructure& structure, const RulingMesh& mesh, const ShellState& state,
                   Frame& frame) {
  const Eigen::Index m = mesh.piece.size();
  Eigen::MatrixXd piece(m, 1), kind(m, 1);
  for (Eigen::Index f = 0; f < m; ++f) {
    piece(f, 0) = mesh.piece[f];
    kind(f, 0) = kind_number(structure, mesh.piece[f]);
  }
  Part& surface = frame.parts["surface"];
  surface.arrays.push_back({"piece", "1", NamedArray::On::cells, piece});
  surface.arrays.push_back({"kind", "1", NamedArray::On::cells, kind});
  frame.parts["rulings"] = rulings_part(structure, mesh, state);
  frame.parts["singular_points"] = points_part(structure, mesh, state);
  frame.tables["pieces"] = pieces_table(structure);
  frame.tables["singular_points"] = points_table(structure);
  double cylinders = 0, cones = 0;
  for (const PaperPiece& p : structure.pieces) {
    cylinders += p.kind == PaperPiece::Kind::cylinder ? 1 : 0;
    cones += p.kind == PaperPiece::Kind::cone ? 1 : 0;
  }
  frame.diagnostics["cylinders"] = cylinders;
  frame.diagnostics["cones"] = cones;
  frame.diagnostics["flats"] = static_cast<double>(structure.pieces.size()) - cylinders - cones;
  frame.diagnostics["rulings"] = static_cast<double>(structure.rulings.size());
  frame.diagnostics["singular_points"] = static_cast<double>(structure.singular_points.size());
}

}  // namespace geoprior::paper
