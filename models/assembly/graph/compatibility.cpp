#include "models/assembly/graph/compatibility.h"

#include "core/disjoint_sets.h"

namespace geoprior::assembly {

Compatibility::Compatibility(const AssemblySet& set, bool with_symmetries) {
  int ports = 0;
  for (const PartType& type : set.types) {
    first_.push_back(ports);
    ports += static_cast<int>(type.ports.size());
  }
  DisjointSets alike(ports);
  if (with_symmetries)
    for (std::size_t t = 0; t < set.types.size(); ++t)
      for (const Symmetry& symmetry : set.types[t].symmetries)
        for (std::size_t i = 0; i < symmetry.ports.size(); ++i)
          alike.join(first_[t] + static_cast<int>(i), first_[t] + symmetry.ports[i]);
  class_of_.assign(ports, -1);
  std::vector<int> number(ports, -1);
  for (int port = 0; port < ports; ++port) {
    int& k = number[alike.find(port)];
    if (k < 0) k = count_++;
    class_of_[port] = k;
  }
  seen_with_.resize(count_);
  for (const Assembly& model : set.models)
    for (const Connection& c : model.connections) {
      const int a = port_class(model, c.a), b = port_class(model, c.b);
      seen_with_[a].push_back(b);
      seen_with_[b].push_back(a);
    }
  for (std::vector<int>& seen : seen_with_) {
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  }
}

}  // namespace geoprior::assembly
