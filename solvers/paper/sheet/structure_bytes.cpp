#include "solvers/paper/sheet/structure_bytes.h"

namespace geoprior::paper {
namespace {

constexpr int kNone = -1;

void write_point(const Eigen::Vector2d& p, StateWriter& out) {
  out.number(p.x());
  out.number(p.y());
}

Eigen::Vector2d read_point(StateReader& in) {
  const double x = in.number<double>();
  const double y = in.number<double>();
  return {x, y};
}

std::optional<int> read_optional(StateReader& in) {
  const int i = in.number<int>();
  return i == kNone ? std::nullopt : std::optional(i);
}

}  // namespace

void write_structure(const PaperStructure& structure, StateWriter& out) {
  out.number(structure.rulings.size());
  for (const Ruling& r : structure.rulings) {
    write_point(r.a, out);
    write_point(r.b, out);
    out.number(r.piece);
    out.number(r.singular_a.value_or(kNone));
    out.number(r.singular_b.value_or(kNone));
    out.number(r.age_frames);
    out.number(r.unbent_frames);
    out.number(r.astray_frames);
  }
  out.number(structure.singular_points.size());
  for (const SingularPoint& s : structure.singular_points) {
    out.number(s.id);
    write_point(s.position, out);
    out.number(s.birth);
    out.number(s.weakening);
    out.number(s.on_border);
    out.number(s.tear.value_or(kNone));
  }
  out.number(structure.pieces.size());
  for (const PaperPiece& piece : structure.pieces) {
    out.number(piece.kind);
    out.number(piece.id);
  }
  out.number(structure.next_piece_id);
  out.number(structure.fine_places.size());
  for (const FinePlace& place : structure.fine_places) {
    write_point(place.centre, out);
    out.number(place.edge);
  }
}

PaperStructure read_structure(StateReader& in) {
  PaperStructure structure;
  structure.rulings.resize(in.count());
  for (Ruling& r : structure.rulings) {
    r.a = read_point(in);
    r.b = read_point(in);
    r.piece = in.number<int>();
    r.singular_a = read_optional(in);
    r.singular_b = read_optional(in);
    r.age_frames = in.number<int>();
    r.unbent_frames = in.number<int>();
    r.astray_frames = in.number<int>();
  }
  structure.singular_points.resize(in.count());
  for (SingularPoint& s : structure.singular_points) {
    s.id = in.number<int>();
    s.position = read_point(in);
    s.birth = in.number<double>();
    s.weakening = in.number<double>();
    s.on_border = in.number<bool>();
    s.tear = read_optional(in);
  }
  structure.pieces.resize(in.count());
  for (PaperPiece& piece : structure.pieces) {
    piece.kind = in.number<PaperPiece::Kind>();
    piece.id = in.number<int>();
  }
  structure.next_piece_id = in.number<int>();
  structure.fine_places.resize(in.count());
  for (FinePlace& place : structure.fine_places) {
    place.centre = read_point(in);
    place.edge = in.number<double>();
  }
  return structure;
}

}  // namespace geoprior::paper
