#include <algorithm>
#include <set>

#include "experiments/embryo/measures/surfaces.h"
#include "metrics/contact/penetration.h"

namespace geoprior::embryo {
namespace {

using Pair = std::pair<int, int>;

/// Pairs of structures whose contact the ontology declares.
class Contacts {
 public:
  explicit Contacts(const Ontology& ontology) {
    for (std::size_t i = 0; i < ontology.structures.size(); ++i) {
      const int a = static_cast<int>(i);
      const Structure& one = ontology.structures[i];
      for (const int b : one.touches) add(a, b);
      for (const int b : one.fused_with) add(a, b);
      for (const Key& key : one.keys) {
        if (key.geometry.start.structure) add(a, *key.geometry.start.structure);
        if (key.geometry.end.structure) add(a, *key.geometry.end.structure);
      }
    }
    for (const ProcessEntry& process : ontology.processes) {
      add_all(process.fuses);
      if (process.kind != ProcessKind::division) continue;
      std::vector<int> all = process.produces;
      all.insert(all.end(), process.acts_on.begin(), process.acts_on.end());
      if (process.septum) all.push_back(*process.septum);
      add_all(all);
    }
  }
  [[nodiscard]] bool declared(const std::vector<int>& some, const std::vector<int>& others) const {
    return std::any_of(some.begin(), some.end(), [&](int a) {
      return std::any_of(others.begin(), others.end(),
                         [&](int b) { return a == b || pairs_.contains(std::minmax(a, b)); });
    });
  }

 private:
  void add(int a, int b) { pairs_.insert(std::minmax(a, b)); }
  void add_all(const std::vector<int>& structures) {
    for (const int a : structures)
      for (const int b : structures)
        if (a != b) add(a, b);
  }

  std::set<Pair> pairs_;
};

bool boxes_meet(const TriMesh& a, const TriMesh& b) {
  const Eigen::RowVector3d low = a.V.colwise().minCoeff().cwiseMax(b.V.colwise().minCoeff());
  const Eigen::RowVector3d high = a.V.colwise().maxCoeff().cwiseMin(b.V.colwise().maxCoeff());
  return (low.array() <= high.array()).all();
}

}  // namespace

std::optional<double> undeclared_overlap(const EmbryoScene& scene,
                                         const std::vector<RecordedPiece>& pieces) {
  if (pieces.empty()) return std::nullopt;
  const Contacts contacts(scene.ontology);
  double worst = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j) {
      if (contacts.declared(pieces[i].structures, pieces[j].structures)) continue;
      if (!boxes_meet(pieces[i].mesh, pieces[j].mesh)) continue;
      worst = std::max(worst, penetration(pieces[i].mesh, pieces[j].mesh));
    }
  }
  return worst;
}

}  // namespace geoprior::embryo
