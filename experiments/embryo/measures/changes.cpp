#include "experiments/embryo/measures/changes.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "metrics/shape/surface_distance.h"

namespace geoprior::embryo {
namespace {

/// Numbers that tell a structure's geometry apart, bit by bit.
using Bytes = std::vector<double>;

std::map<int, Bytes> geometry_of(const Frame& frame) {
  std::map<int, Bytes> out;
  if (const Part* surface = frame.find_part(recorded::kSurface)) {
    const NamedArray& codes =
        surface->require_array(recorded::kStructure, NamedArray::On::cells, 1, "surface");
    for (Eigen::Index t = 0; t < surface->triangles.rows(); ++t) {
      Bytes& bytes = out[static_cast<int>(codes.values(t, 0))];
      for (const int corner : surface->triangles.row(t)) {
        const Eigen::RowVector3d x = surface->points.row(corner);
        bytes.insert(bytes.end(), x.data(), x.data() + 3);
      }
    }
  }
  if (const Part* lines = frame.find_part(recorded::kCentrelines)) {
    const NamedArray& codes =
        lines->require_array(recorded::kStructure, NamedArray::On::cells, 1, "centrelines");
    for (std::size_t l = 0; l < lines->lines.size(); ++l) {
      Bytes& bytes = out[static_cast<int>(codes.values(static_cast<Eigen::Index>(l), 0))];
      for (const int point : lines->lines[l]) {
        const Eigen::RowVector3d x = lines->points.row(point);
        bytes.insert(bytes.end(), x.data(), x.data() + 3);
      }
    }
  }
  return out;
}

bool same_bytes(const Bytes& a, const Bytes& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Which structures are there some day, and which differ some day.
struct Compared {
  std::set<int> here, there, differ;
};

Compared compared(const FrameSequence& frames, const FrameSequence& reference) {
  Compared c;
  std::size_t r = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    while (r < reference.size() && reference.parameter(r) < frames.parameter(i)) ++r;
    if (r == reference.size() || reference.parameter(r) != frames.parameter(i)) continue;
    const auto mine = geometry_of(*frames.frame(i));
    const auto others = geometry_of(*reference.frame(r));
    for (const auto& [structure, bytes] : mine) {
      c.here.insert(structure);
      const auto other = others.find(structure);
      if (other == others.end() || !same_bytes(bytes, other->second)) c.differ.insert(structure);
    }
    for (const auto& [structure, bytes] : others) {
      c.there.insert(structure);
      if (!mine.contains(structure)) c.differ.insert(structure);
    }
  }
  return c;
}

/// Names in one of both lists only. What gets no surface is not asked for.
double errors(const EmbryoScene& scene, const std::set<int>& found,
              const std::vector<std::string>& expected) {
  std::set<std::string> names, wanted;
  for (const int s : found)
    if (scene.meshed[s]) names.insert(scene.structure_names[s]);
  for (const std::string& name : expected) {
    const auto code = scene.ontology.find_structure(name);
    if (!code || scene.meshed[*code]) wanted.insert(name);
  }
  std::vector<std::string> only_one;
  std::set_symmetric_difference(names.begin(), names.end(), wanted.begin(), wanted.end(),
                                std::back_inserter(only_one));
  return static_cast<double>(only_one.size());
}

/// The side that the disease leaves alone; empty where it is of both or of none.
std::string other_side(const EmbryoScene& scene) {
  if (!scene.disease) return {};
  const std::string& side = scene.ontology.diseases[*scene.disease].side;
  return side == "left" ? "right" : side == "right" ? "left" : "";
}

double shape_difference(const Shape& a, const Shape& b) {
  return std::max({(a.center - b.center).cwiseAbs().maxCoeff(),
                   (a.radii - b.radii).cwiseAbs().maxCoeff(),
                   (a.axes - b.axes).cwiseAbs().maxCoeff() * a.radii.maxCoeff()});
}

/// Largest distance of a vertex of one from the other, both ways.
double surface_distance(const TriMesh& a, const TriMesh& b) {
  if (a.V.rows() == b.V.rows() && a.F.rows() == b.F.rows() && a.V == b.V && a.F == b.F) return 0;
  return std::max(largest_distance(a.V, b), largest_distance(b.V, a));
}

}  // namespace

std::optional<ChangeMeasures> change_measures(const EmbryoScene& scene,
                                              const FrameSequence& frames) {
  const FrameSequence* reference = frames.reference();
  if (reference == nullptr) return std::nullopt;
  const Compared c = compared(frames, *reference);
  std::set<int> absent, altered;
  std::set_difference(c.there.begin(), c.there.end(), c.here.begin(), c.here.end(),
                      std::inserter(absent, absent.end()));
  std::set_difference(c.differ.begin(), c.differ.end(), absent.begin(), absent.end(),
                      std::inserter(altered, altered.end()));
  ChangeMeasures m;
  m.absent = static_cast<double>(absent.size());
  m.altered = static_cast<double>(altered.size());
  if (scene.expected) {
    m.absent_errors = errors(scene, absent, scene.expected->absent);
    m.altered_errors = errors(scene, altered, scene.expected->altered);
  }
  if (const std::string side = other_side(scene); !side.empty()) {
    m.other_side = static_cast<double>(std::count_if(c.differ.begin(), c.differ.end(), [&](int s) {
      return scene.ontology.structures[s].side == side;
    }));
  }
  return m;
}

std::optional<DifferenceMeasures> difference_measures(const EmbryoScene& scene, const Frame& frame,
                                                      const Frame& reference) {
  if (frame.find_table(recorded::kBody) == nullptr ||
      reference.find_table(recorded::kBody) == nullptr)
    return std::nullopt;
  DifferenceMeasures m;
  const double body = crown_rump_length(reference);
  const std::vector<RecordedShape> others = recorded_shapes(reference);
  for (const RecordedShape& one : recorded_shapes(frame)) {
    const RecordedShape* other = find_shape(others, one.structure);
    if (other == nullptr || !scene.meshed[one.structure]) continue;
    m.state = std::max(m.state.value_or(0), shape_difference(one.shape, other->shape) / body);
  }
  const auto mine = recorded_surfaces(frame), theirs = recorded_surfaces(reference);
  for (const auto& [structure, mesh] : theirs) {
    const auto found = mine.find(structure);
    if (found == mine.end()) {
      ++m.unmatched;
      continue;
    }
    m.surface = std::max(m.surface.value_or(0), surface_distance(found->second, mesh) / body);
  }
  for (const auto& [structure, mesh] : mine) m.unmatched += theirs.contains(structure) ? 0 : 1;
  return m;
}

}  // namespace geoprior::embryo
