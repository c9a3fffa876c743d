#include "models/embryo/ontology/ontology.h"

#include <algorithm>

namespace geoprior::embryo {
namespace {

template <class Entry>
std::optional<int> place_of(const std::vector<Entry>& entries, const std::string& name) {
  const auto found = std::ranges::find(entries, name, &Entry::name);
  if (found == entries.end()) return std::nullopt;
  return static_cast<int>(found - entries.begin());
}

}  // namespace

std::optional<int> Ontology::find_structure(const std::string& name) const {
  return place_of(structures, name);
}

std::optional<int> Ontology::find_stage(const std::string& name) const {
  return place_of(stages, name);
}

std::optional<int> Ontology::find_process(const std::string& name) const {
  return place_of(processes, name);
}

std::optional<int> Ontology::find_disease(const std::string& name) const {
  return place_of(diseases, name);
}

}  // namespace geoprior::embryo
