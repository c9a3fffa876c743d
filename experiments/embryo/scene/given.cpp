#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/embryo/frames/day_frame.h"
#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/poses/answers.h"
#include "experiments/embryo/scene/scene.h"
#include "solvers/embryo/state/development.h"
#include "testbed/given_tables.h"

namespace geoprior::embryo {
namespace {

double code_of(const std::optional<int>& structure) { return structure ? *structure : -1; }

void give_time(const Ontology& ontology, Frame& frame) {
  TableBuilder stages({"stage", "first [d]", "middle [d]", "last [d]"});
  for (int s = 0; s < std::ssize(ontology.stages); ++s) {
    const Stage& stage = ontology.stages[s];
    stages.add({1. * s, stage.start_day, stage.middle(), stage.end_day});
  }
  frame.tables["stages"] = stages.finished();
  TableBuilder body({"day [d]", "crown_rump_length [m]"});
  for (const auto& [day, length] : ontology.crown_rump_length) body.add({day, length});
  frame.tables[recorded::kBody] = body.finished();
}

FrameTable catalogue(const EmbryoScene& scene) {
  const std::vector<bool> named = scene.named_structures();
  TableBuilder table({"structure", "kind", "surface", "named", "mirror_of"});
  for (int s = 0; s < std::ssize(scene.ontology.structures); ++s)
    table.add({1. * s, 1. * scene.kind_of_structure[s], scene.meshed[s] ? 1. : 0.,
               named[s] ? 1. : 0., code_of(scene.ontology.structures[s].mirror_of)});
  return table.finished();
}

/// Numbers of keys are counted over all structures.
class KeyTables {
 public:
  void add(int structure, const Key& key) {
    const Geometry& g = key.geometry;
    keys_.add({number_,          1. * structure, key.day,        static_cast<double>(g.primitive),
               code_of(g.frame), g.position.x(), g.position.y(), g.position.z(),
               g.axis.x(),       g.axis.y(),     g.axis.z(),     g.up.x(),
               g.up.y(),         g.up.z(),       g.radii.x(),    g.radii.y(),
               g.radii.z(),      g.egg,          g.radius,       g.end_radius,
               g.branchings});
    if (g.primitive == Primitive::duct) {
      for (const auto& [end, anchor] : {std::pair(0., g.start), std::pair(1., g.end)})
        ends_.add(
            {number_, end, code_of(anchor.structure), anchor.at.x(), anchor.at.y(), anchor.at.z()});
      for (const Eigen::Vector3d& x : g.via) via_.add({number_, x.x(), x.y(), x.z()});
    }
    number_ += 1;
  }
  void give(Frame& frame) const {
    frame.tables["keys"] = keys_.finished();
    frame.tables["ends"] = ends_.finished();
    frame.tables["via"] = via_.finished();
  }

 private:
  double number_ = 0;
  TableBuilder keys_{
      {"key",    "structure", "day [d]",    "primitive",      "frame",     "x",    "y",     "z",
       "axis_x", "axis_y",    "axis_z",     "up_x",           "up_y",      "up_z", "a [m]", "b [m]",
       "c [m]",  "egg",       "radius [m]", "end_radius [m]", "branchings"}};
  TableBuilder ends_{{"key", "end", "structure", "u", "v", "w"}};
  TableBuilder via_{{"key", "x", "y", "z"}};
};

/// The healthy body in the middles of the stages: between keys as `Development` has it.
void give_healthy(const EmbryoScene& scene, Frame& frame) {
  const Development development(scene.ontology, scene.healthy_effects, {});
  std::optional<TableBuilder> structures;
  for (int s = 0; s < std::ssize(scene.ontology.stages); ++s) {
    const double day = scene.ontology.stages[s].middle();
    const Frame middle = day_frame(scene, development.at(day), {});
    frame.parts[numbered(recorded::kCentrelines, s)] = middle.require_part(recorded::kCentrelines);
    const FrameTable& table = middle.require_table(recorded::kShapes);
    if (!structures) {
      std::vector<std::string> columns{"day [d]"};
      columns.insert(columns.end(), table.columns.begin(), table.columns.end());
      structures.emplace(columns);
    }
    for (Eigen::Index r = 0; r < table.rows.rows(); ++r) {
      std::vector<double> row{day};
      for (Eigen::Index c = 0; c < table.rows.cols(); ++c) row.push_back(table.rows(r, c));
      structures->add(row);
    }
  }
  if (structures) frame.tables[recorded::kShapes] = structures->finished();
}

FrameTable questions(const EmbryoScene& scene) {
  TableBuilder table({"frame", "day [d]", "structure", "system"});
  for (int i = 0; i < std::ssize(scene.days); ++i) {
    const ViewerQuestion question = question_of(scene, scene.days[i]);
    table.add({1. * i, question.day, code_of(scene.ontology.find_structure(question.structure)),
               code_of(scene.ontology.find_structure(question.system))});
  }
  return table.finished();
}

}  // namespace

Frame EmbryoScene::given() const {
  Frame frame;
  give_time(ontology, frame);
  frame.tables["catalogue"] = catalogue(*this);
  KeyTables keys;
  for (int s = 0; s < std::ssize(ontology.structures); ++s)
    for (const Key& key : ontology.structures[s].keys) keys.add(s, key);
  keys.give(frame);
  give_healthy(*this, frame);
  frame.tables["questions"] = questions(*this);
  return frame;
}

}  // namespace geoprior::embryo
