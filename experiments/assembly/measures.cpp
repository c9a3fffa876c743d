#include "experiments/assembly/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "metrics/contact/self_contact.h"
#include "metrics/graphs/differences.h"
#include "metrics/graphs/plan_distance.h"
#include "models/assembly/exchange/embedding.h"
#include "models/assembly/graph/compatibility.h"
#include "models/assembly/graph/labels.h"
#include "models/assembly/isomorphism/canonical.h"
#include "models/assembly/search/rules.h"
#include "models/assembly/search/variation.h"

namespace geoprior::assembly {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

Value count_labelled(const AssemblyScene& scene, const Assembly& assembly,
                     const std::optional<PartCount>& rule) {
  if (!rule) return std::nullopt;
  return static_cast<double>(
      std::count_if(assembly.parts.begin(), assembly.parts.end(), [&](const PlacedPart& part) {
        return is_among(rule->labels, scene.input.set.types[part.type].label);
      }));
}

/// Lowest z of the triangles of each grounded part.
Value ground_gap(const AssemblyScene& scene, const Frame& frame) {
  if (scene.input.rules.grounded.empty()) return std::nullopt;
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  const Eigen::MatrixXd& part =
      surface.require_array("part", NamedArray::On::cells, 1, "surface").values;
  const Eigen::MatrixXd& label =
      surface.require_array("label", NamedArray::On::cells, 1, "surface").values;
  std::map<int, double> lowest;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const PartType& type = scene.input.set.types[static_cast<int>(label(t, 0))];
    if (!is_among(scene.input.rules.grounded, type.label)) continue;
    double& z =
        lowest.try_emplace(static_cast<int>(part(t, 0)), std::numeric_limits<double>::infinity())
            .first->second;
    for (int k = 0; k < 3; ++k) z = std::min(z, surface.points(surface.triangles(t, k), 2));
  }
  double gap = 0;
  for (const auto& [number, z] : lowest) gap = std::max(gap, std::abs(z));
  return gap;
}

/// Where ways end inside the parts that are exits.
std::vector<Eigen::Vector3d> exit_points(const AssemblyScene& scene, const Assembly& assembly) {
  std::vector<Eigen::Vector3d> out;
  if (!scene.input.rules.exits) return out;
  for (const PlacedPart& part : assembly.parts) {
    const PartType& type = scene.input.set.types[part.type];
    if (!is_among(scene.input.rules.exits->labels, type.label)) continue;
    for (const Way& way : type.ways)
      if (way.to == Way::kInside) out.push_back(part.pose * way.points.back());
  }
  return out;
}

std::vector<Eigen::Vector3d> line_points(const Part& lines, std::size_t i) {
  std::vector<Eigen::Vector3d> out;
  for (const int p : lines.lines[i]) out.emplace_back(lines.points.row(p).transpose());
  return out;
}

double rise_of(const std::vector<Eigen::Vector3d>& line) {
  double rise = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
    for (std::size_t j = i + 1; j < line.size(); ++j)
      rise = std::max(rise, line[j].z() - line[i].z());
  return rise;
}

void measure_ways(const AssemblyScene& scene, const Frame& frame, const Assembly& assembly,
                  StandMeasures& out) {
  if (!scene.input.rules.rise) return;
  constexpr double kSamePlace = 1e-3;  // m
  const Part& ways = frame.require_part("ways", Part::Kind::lines);
  const std::vector<Eigen::Vector3d> ends = exit_points(scene, assembly);
  out.rise = 0;
  out.lost_ways = 0;
  for (std::size_t i = 0; i < ways.lines.size(); ++i) {
    const std::vector<Eigen::Vector3d> line = line_points(ways, i);
    out.rise = std::max(*out.rise, rise_of(line));
    if (std::none_of(ends.begin(), ends.end(), [&](const Eigen::Vector3d& x) {
          return (x - line.back()).norm() <= kSamePlace;
        }))
      *out.lost_ways += 1;
  }
}

}  // namespace

JointMeasures joint_measures(const AssemblyScene& scene, const Frame& frame) {
  const Assembly assembly = variation_of(frame).assembly;
  const AssemblySet& set = scene.input.set;
  JointMeasures out;
  const Compatibility compatibility(set, true);
  // Round-off of poses that go through files and products of many frames.
  constexpr double kRoundOff = 1e-9;
  for (const Misfit& m : joint_misfits(assembly, set.types)) {
    out.gap = std::max(out.gap.value_or(0), m.translation);
    out.angle = std::max(out.angle.value_or(0), m.angle * kDegrees);
    if (m.translation > scene.input_misfit.translation + kRoundOff ||
        m.angle > scene.input_misfit.angle + kRoundOff)
      ++out.over_input;
  }
  for (const auto& [a, b] : assembly.connections)
    if (!compatibility.observed(compatibility.port_class(assembly, a),
                                compatibility.port_class(assembly, b)))
      ++out.unseen;
  return out;
}

StandMeasures stand_measures(const AssemblyScene& scene, const Frame& frame) {
  const Assembly assembly = variation_of(frame).assembly;
  StandMeasures out;
  out.ground_gap = ground_gap(scene, frame);
  out.entries = count_labelled(scene, assembly, scene.input.rules.entries);
  out.exits = count_labelled(scene, assembly, scene.input.rules.exits);
  measure_ways(scene, frame, assembly, out);
  return out;
}

namespace {

/// Triangles of each part, and the box around them.
struct PartTriangles {
  std::vector<int> triangles;
  Eigen::AlignedBox3d bounds;
};

Eigen::AlignedBox3d triangle_bounds(const Part& surface, int t) {
  Eigen::AlignedBox3d box;
  for (int k = 0; k < 3; ++k)
    box.extend(surface.points.row(surface.triangles(t, k)).transpose().eval());
  return box;
}

std::vector<PartTriangles> triangles_of_parts(const Part& surface, std::size_t parts) {
  const Eigen::MatrixXd& part =
      surface.require_array("part", NamedArray::On::cells, 1, "surface").values;
  std::vector<PartTriangles> out(parts);
  for (int t = 0; t < static_cast<int>(surface.triangles.rows()); ++t) {
    PartTriangles& of = out.at(static_cast<std::size_t>(part(t, 0)));
    of.triangles.push_back(t);
    of.bounds.extend(triangle_bounds(surface, t));
  }
  return out;
}

/// Whether triangles of two parts intersect: those near the other part's box are tried.
bool triangles_meet(const Part& surface, const PartTriangles& a, const PartTriangles& b) {
  const Eigen::AlignedBox3d both = a.bounds.intersection(b.bounds);
  if (both.isEmpty()) return false;
  std::vector<int> near, layer;
  for (const PartTriangles* of : {&a, &b})
    for (const int t : of->triangles)
      if (!triangle_bounds(surface, t).intersection(both).isEmpty()) {
        near.push_back(t);
        layer.push_back(of == &a ? 0 : 1);
      }
  Eigen::MatrixX3i triangles(static_cast<Eigen::Index>(near.size()), 3);
  for (std::size_t i = 0; i < near.size(); ++i)
    triangles.row(static_cast<Eigen::Index>(i)) = surface.triangles.row(near[i]);
  return !pairs_between_layers(intersecting_triangles(surface.points, triangles), layer).empty();
}

}  // namespace

Value meeting_parts(const AssemblyScene& scene, const Frame& frame) {
  if (scene.input.survey || !scene.input.rules.collisions) return std::nullopt;
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  const Assembly assembly = variation_of(frame).assembly;
  const std::vector<PartTriangles> parts = triangles_of_parts(surface, assembly.parts.size());
  std::set<std::pair<int, int>> joined;
  for (const auto& [a, b] : assembly.connections) joined.insert(std::minmax(a.part, b.part));
  double meeting = 0;
  for (int a = 0; a < static_cast<int>(parts.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(parts.size()); ++b)
      if (!joined.contains({a, b}) && triangles_meet(surface, parts[a], parts[b])) ++meeting;
  return meeting;
}

namespace {

std::vector<double> label_histogram(const Assembly& assembly, std::size_t types) {
  std::vector<double> out(types, 0.);
  for (const PlacedPart& part : assembly.parts) ++out[part.type];
  return out;
}

Eigen::VectorXd spectrum(const Assembly& assembly) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& [a, b] : assembly.connections) edges.push_back({a.part, b.part});
  return laplacian_spectrum(static_cast<int>(assembly.parts.size()), edges);
}

}  // namespace

std::optional<VarietyMeasures> variety_measures(const AssemblyScene& scene, const Frame& frame) {
  if (scene.input.survey || frame.parameter <= 0) return std::nullopt;
  const Variation variation = variation_of(frame);
  const AssemblySet& set = scene.input.set;
  VarietyMeasures out{std::numeric_limits<double>::infinity(),
                      std::numeric_limits<double>::infinity(), 0,
                      static_cast<double>(variation.assembly.parts.size())};
  const std::vector<double> labels = label_histogram(variation.assembly, set.types.size());
  const Eigen::VectorXd eigenvalues = spectrum(variation.assembly);
  for (const Assembly& model : set.models) {
    out.labels =
        std::min(out.labels, histogram_distance(labels, label_histogram(model, set.types.size())));
    out.spectrum = std::min(out.spectrum, spectral_distance(eigenvalues, spectrum(model)));
  }
  for (const int origin : variation.origin)
    if (origin != Variation::kKept) out.exchanged += 1 / out.parts;
  return out;
}

TargetMeasures target_measures(const AssemblyScene& scene, const Frame& frame) {
  TargetMeasures out;
  const auto& target = scene.input.guide.target;
  if (!target) return out;
  const Part& ways = frame.require_part("ways", Part::Kind::lines);
  std::vector<std::vector<Eigen::Vector2d>> lines;
  for (std::size_t i = 0; i < ways.lines.size(); ++i) {
    auto& line = lines.emplace_back();
    for (const Eigen::Vector3d& x : line_points(ways, i)) line.emplace_back(x.head<2>());
  }
  if (lines.empty()) return out;
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < target->x.size(); ++i)
    corners.emplace_back(target->x[i], target->y[i]);
  if (target->kind == Target::Kind::outline) {
    const PlanDistance d = plan_distance(lines, corners, target->spacing);
    out.distance = (d.to_target + d.from_target) / 2;
  } else {
    out.fill = plan_fill(lines, corners, target->spacing, target->spacing);
  }
  return out;
}

BestMeasures best_measures(const AssemblyScene& scene, const FrameSequence& frames) {
  BestMeasures out;
  if (!scene.input.guide.target) return out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const TargetMeasures m = target_measures(scene, *frames.frame(i));
    if (m.distance) out.distance = std::min(out.distance.value_or(*m.distance), *m.distance);
    if (m.fill) out.fill = std::max(out.fill.value_or(*m.fill), *m.fill);
  }
  return out;
}

std::optional<RunMeasures> run_measures(const AssemblyScene& scene, const FrameSequence& frames) {
  if (scene.input.survey) return std::nullopt;
  const AssemblySet& set = scene.input.set;
  std::set<CanonicalKey> keys;
  for (const Assembly& model : set.models) keys.insert(canonical_key(model, set.types, true));
  const std::size_t inputs = keys.size();
  std::vector<std::vector<double>> labels;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames.parameter(i) <= 0) continue;
    const Assembly assembly = variation_of(*frames.frame(i)).assembly;
    keys.insert(canonical_key(assembly, set.types, true));
    labels.push_back(label_histogram(assembly, set.types.size()));
  }
  RunMeasures out{static_cast<double>(labels.size()), static_cast<double>(keys.size() - inputs), 0};
  double pairs = 0;
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t j = i + 1; j < labels.size(); ++j) {
      out.spread += histogram_distance(labels[i], labels[j]);
      ++pairs;
    }
  if (pairs > 0) out.spread /= pairs;
  return out;
}

namespace {

/// Columns of a table that begin with "set_".
std::pair<int, int> set_columns(const FrameTable& table) {
  int words = 0;
  for (const std::string& column : table.columns)
    if (column.rfind("set_", 0) == 0) ++words;
  return {2, words};
}

/// A substructure as its words, and its pairs.
using Listed = std::map<std::vector<double>, std::pair<double, double>>;

Listed listed(const FrameTable& table) {
  Listed out;
  const auto [first, words] = set_columns(table);
  const bool has_pairs = table.rows.cols() > first + words;
  for (Eigen::Index row = 0; row < table.rows.rows(); ++row) {
    std::vector<double> set(words);
    for (int w = 0; w < words; ++w) set[w] = table.rows(row, first + w);
    out[set] = has_pairs
                   ? std::pair(table.rows(row, first + words), table.rows(row, first + words + 1))
                   : std::pair(0., 0.);
  }
  return out;
}

bool holds(const std::vector<double>& set, int part) {
  constexpr int kWordBits = 48;
  return static_cast<std::uint64_t>(set[part / kWordBits]) >> (part % kWordBits) & 1;
}

/// Connections with one end in a set, and in how many pieces the others are.
struct CutOut {
  std::vector<int> boundary;
  int pieces = 0;
};

CutOut cut_out(const Assembly& model, const std::vector<double>& set) {
  CutOut out;
  Assembly others;
  std::vector<int> number(model.parts.size(), -1);
  for (int part = 0; part < static_cast<int>(model.parts.size()); ++part) {
    if (holds(set, part)) continue;
    number[part] = static_cast<int>(others.parts.size());
    others.parts.push_back(model.parts[part]);
  }
  for (std::size_t c = 0; c < model.connections.size(); ++c) {
    const auto [a, b] = model.connections[c];
    if (number[a.part] >= 0 && number[b.part] >= 0)
      others.connections.push_back({{number[a.part], a.port}, {number[b.part], b.port}});
    else if (number[a.part] >= 0 || number[b.part] >= 0)
      out.boundary.push_back(static_cast<int>(c));
  }
  out.pieces = components(others).count;
  return out;
}

void measure_substructures(const Assembly& model, const Listed& all, SurveyMeasures& out) {
  std::set<std::vector<int>> boundaries;
  const int pieces = components(model).count;
  for (const auto& [set, pairs] : all) {
    const CutOut cut = cut_out(model, set);
    boundaries.insert(cut.boundary);
    // What is left of a connected model is one piece where the boundary is a bond.
    if (cut.pieces > pieces) ++out.unions;
  }
  for (const std::vector<int>& boundary : boundaries)
    if (!boundary.empty() && boundary.size() <= 4) ++out.boundaries[boundary.size() - 1];
}

/// Sums of a histogram of gaps, and its median: the middle of its bin.
void measure_residuals(const Eigen::MatrixXd& bins, SurveyMeasures& out) {
  out.residuals = bins.col(2).sum();
  if (out.residuals == 0) return;
  out.closing_share = bins.col(3).sum() / out.residuals;
  double below = 0;
  for (Eigen::Index i = 0; i < bins.rows() && !out.residual_median; ++i) {
    below += bins(i, 2);
    if (2 * below >= out.residuals) out.residual_median = (bins(i, 0) + bins(i, 1)) / 2;
  }
}

}  // namespace

std::optional<SurveyMeasures> survey_measures(const AssemblyScene& scene, const Frame& frame) {
  const FrameTable* table = frame.find_table("substructures");
  if (table == nullptr) return std::nullopt;
  SurveyMeasures out;
  const Listed all = listed(*table);
  out.substructures = static_cast<double>(all.size());
  measure_substructures(scene.input.set.models.at(static_cast<std::size_t>(frame.parameter)), all,
                        out);
  if (scene.input.survey->pairs) {
    out.pairs = 0;
    for (const auto& [set, pairs] : all) *out.pairs += pairs.first;
  }
  out.outputs = static_cast<double>(frame.require_table("outputs").rows.rows());
  measure_residuals(frame.require_table("residuals").rows, out);
  return out;
}

std::optional<CoverageMeasures> coverage_measures(const AssemblyScene& scene, const Frame& frame,
                                                  const Frame& reference) {
  const FrameTable *mine = frame.find_table("substructures"),
                   *theirs = reference.find_table("substructures");
  if (mine == nullptr || theirs == nullptr) return std::nullopt;
  const Listed found = listed(*mine), all = listed(*theirs);
  CoverageMeasures out;
  double there = 0, pairs = 0, pairs_there = 0;
  for (const auto& [set, of_all] : all) {
    pairs += of_all.first;
    const auto it = found.find(set);
    if (it == found.end()) continue;
    ++there;
    const auto [count, sum] = it->second;
    // Sums tell whether equal numbers are equal sets.
    const bool are_theirs = count < of_all.first || sum == of_all.second;
    pairs_there += are_theirs ? std::min(count, of_all.first) : 0;
    out.false_pairs += are_theirs ? std::max(0., count - of_all.first) : count;
  }
  out.false_substructures = static_cast<double>(found.size()) - there;
  // Rows, not sets: what is listed twice is one too many.
  out.substructure_errors =
      static_cast<double>(all.size()) - there + (static_cast<double>(mine->rows.rows()) - there);
  if (!all.empty()) out.substructures = there / static_cast<double>(all.size());
  if (scene.input.survey->pairs && pairs > 0) out.pairs = pairs_there / pairs;
  const auto keys = [](const Frame& f) {
    const Eigen::MatrixXd& rows = f.require_table("outputs").rows;
    std::set<std::vector<double>> out_keys;
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      out_keys.insert({rows(i, 0), rows(i, 1), rows(i, 2), rows(i, 3)});
    return out_keys;
  };
  const auto my_keys = keys(frame), their_keys = keys(reference);
  double outputs_there = 0;
  for (const auto& key : my_keys) outputs_there += their_keys.contains(key);
  if (!their_keys.empty()) out.outputs = outputs_there / static_cast<double>(their_keys.size());
  out.false_outputs = static_cast<double>(my_keys.size()) - outputs_there;
  return out;
}

}  // namespace geoprior::assembly
