#include "baselines/embryo/table/rows.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <string_view>

namespace geoprior::embryo::table {
namespace {

constexpr double kMillimetre = 1e-3;

Eigen::Vector3d vector_of(const Triplet& t) { return {t[0], t[1], t[2]}; }

Geometry& add_key(BodyPlan& plan, int structure, int stage, Primitive primitive) {
  Key key;
  key.stage = stage;
  key.day = middle(plan, stage);
  key.name = plan.structures[structure].name + " at " + plan.stages[stage].name;
  key.geometry.primitive = primitive;
  plan.structures[structure].keys.push_back(key);
  return plan.structures[structure].keys.back().geometry;
}

void set_directions(Geometry& g, const Triplet& axis, const Triplet& up) {
  g.axis = vector_of(axis).normalized();
  const Eigen::Vector3d unit = vector_of(up).normalized();
  g.up = (unit - unit.dot(g.axis) * g.axis).normalized();
}

bool is_sided(const BodyPlan& plan, int structure) {
  const std::string_view name = plan.structures[structure].name;
  return name.starts_with("Left") || name.starts_with("Right");
}

/// The right one of a left structure; a median one itself.
int partner(const BodyPlan& plan, int structure) {
  if (!is_sided(plan, structure)) return structure;
  const std::string name = "Right" + plan.structures[structure].name.substr(4);
  int right = 0;
  while (plan.structures[right].name != name) ++right;
  return right;
}

Eigen::Vector3d mirrored(Eigen::Vector3d v) {
  v.x() = -v.x();
  return v;
}

/// Local y of a structure turns over when its axes x and z are mirrored; a median one keeps its
/// axes.
Anchor mirrored(const BodyPlan& plan, Anchor anchor) {
  const bool on_sided = anchor.structure && is_sided(plan, *anchor.structure);
  if (on_sided) {
    anchor.at.y() = -anchor.at.y();
  } else {
    anchor.at = mirrored(anchor.at);
  }
  if (anchor.structure) anchor.structure = partner(plan, *anchor.structure);
  return anchor;
}

}  // namespace

double middle(const BodyPlan& plan, int stage) { return plan.stages[stage].middle(); }

void set_life(BodyPlan& plan, int structure, int from, int until) {
  for (int stage = 0; stage < kStages; ++stage)
    plan.structures[structure].exists[stage] = stage >= from && stage <= until;
}

void add_point(BodyPlan& plan, int structure, const Triplet& place) {
  add_key(plan, structure, CS13, Primitive::point).position = vector_of(place);
}

void add_line(BodyPlan& plan, int structure, const Triplet& place,
              std::initializer_list<LineRow> rows) {
  for (const LineRow& row : rows) {
    Geometry& g = add_key(plan, structure, row.stage, Primitive::line);
    g.position = vector_of(place);
    g.radii.z() = kMillimetre * row.length / 2;
  }
}

void add_plane(BodyPlan& plan, int structure, const Triplet& normal,
               std::initializer_list<PlaneRow> rows) {
  for (const PlaneRow& row : rows) {
    Geometry& g = add_key(plan, structure, row.stage, Primitive::plane);
    g.position = vector_of(row.place);
    set_directions(g, normal, {1, 0, 0});
    g.radii.head<2>().setConstant(kMillimetre * row.extent);
  }
}

void add_rod(BodyPlan& plan, int structure, std::initializer_list<RodRow> rows) {
  for (const RodRow& row : rows) {
    Geometry& g = add_key(plan, structure, row.stage, Primitive::cylinder);
    g.position = vector_of(row.place);
    g.radius = g.end_radius = kMillimetre * row.radius;
    g.radii = {g.radius, g.radius, kMillimetre * row.length / 2};
  }
}

void add_ovoid(BodyPlan& plan, int structure, const OvoidForm& form,
               std::initializer_list<OvoidRow> rows) {
  for (const OvoidRow& row : rows) {
    Geometry& g = add_key(plan, structure, row.stage, Primitive::ovoid);
    g.position = vector_of(row.place);
    set_directions(g, form.axis, form.up);
    g.radii = kMillimetre * vector_of(row.radii);
    g.egg = form.egg;
  }
}

void add_duct(BodyPlan& plan, int structure, const DuctForm& form,
              std::initializer_list<DuctRow> rows) {
  for (const DuctRow& row : rows) {
    Geometry& g = add_key(plan, structure, row.stage, Primitive::duct);
    g.frame = form.frame;
    g.start = {form.start, vector_of(row.start)};
    g.end = {form.end, vector_of(row.end)};
    for (const Triplet& place : row.via) g.via.push_back(vector_of(place));
    g.radius = kMillimetre * row.radius;
    g.end_radius = kMillimetre * row.end_radius;
    g.branchings = row.branchings;
  }
}

void add_mirrored(BodyPlan& plan, int right, int left) {
  for (Key key : plan.structures[left].keys) {
    Geometry& g = key.geometry;
    key.name = plan.structures[right].name + " at " + plan.stages[key.stage].name;
    if (g.frame) g.frame = partner(plan, *g.frame);
    g.position = mirrored(g.position);
    if (g.primitive == Primitive::ovoid) {
      g.axis = mirrored(g.axis);
      g.up = mirrored(g.up);
    }
    g.start = mirrored(plan, g.start);
    g.end = mirrored(plan, g.end);
    for (Eigen::Vector3d& place : g.via) place = mirrored(place);
    plan.structures[right].keys.push_back(key);
  }
  plan.structures[right].exists = plan.structures[left].exists;
}

}  // namespace geoprior::embryo::table
