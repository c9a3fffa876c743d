#include "models/assembly/isomorphism/canonical.h"

#include <nauty/nausparse.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "models/assembly/isomorphism/key_hash.h"

namespace geoprior::assembly {
namespace {

/// A graph whose vertices have colours, before it is labelled.
struct ColouredGraph {
  std::vector<std::array<int, 3>> colours;  ///< what a vertex is: kind, and two numbers
  std::vector<std::pair<int, int>> edges;

  int add(std::array<int, 3> colour) {
    colours.push_back(colour);
    return static_cast<int>(colours.size()) - 1;
  }
  void join(int a, int b) { edges.emplace_back(a, b); }
};

enum VertexKind { kPart, kPort, kMotion, kImage, kMark };

/// The vertices of a part and its ports; returns the first port's.
int add_part(ColouredGraph& graph, const PartType& type, int type_index, bool symmetries) {
  const int ports = static_cast<int>(type.ports.size());
  const int part = graph.add({kPart, type_index, 0});
  const int first = part + 1;
  const bool alike = symmetries && !type.symmetries.empty();
  for (int i = 0; i < ports; ++i) graph.join(part, graph.add({kPort, type_index, alike ? -1 : i}));
  if (!alike) return first;
  const auto add_motion = [&](const auto& image) {
    const int motion = graph.add({kMotion, type_index, 0});
    graph.join(part, motion);
    for (int i = 0; i < ports; ++i) {
      const int vertex = graph.add({kImage, type_index, image(i)});
      graph.join(motion, vertex);
      graph.join(vertex, first + i);
    }
  };
  add_motion([](int i) { return i; });
  for (const Symmetry& s : type.symmetries) add_motion([&](int i) { return s.ports[i]; });
  return first;
}

/// The graph of some parts; ports that lead out of them are marked, by the colours of `boundary`
/// where it has them.
ColouredGraph graph_of(const Assembly& assembly, const std::vector<PartType>& types,
                       const PartSet* parts, bool symmetries, std::span<const int> boundary = {},
                       std::span<const int> colours = {}) {
  ColouredGraph graph;
  std::vector<int> first_port(assembly.parts.size(), -1);
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    if (parts && !parts->has(static_cast<int>(i))) continue;
    const int type = assembly.parts[i].type;
    first_port[i] = add_part(graph, types[type], type, symmetries);
  }
  for (std::size_t c = 0; c < assembly.connections.size(); ++c) {
    const auto& [a, b] = assembly.connections[c];
    const bool has_a = first_port[a.part] >= 0, has_b = first_port[b.part] >= 0;
    if (has_a && has_b) {
      graph.join(first_port[a.part] + a.port, first_port[b.part] + b.port);
    } else if (has_a || has_b) {
      const auto place = std::find(boundary.begin(), boundary.end(), static_cast<int>(c));
      const PortRef end = has_a ? a : b;
      graph.join(
          first_port[end.part] + end.port,
          graph.add({kMark, place == boundary.end() ? 0 : colours[place - boundary.begin()], 0}));
    }
  }
  return graph;
}

/// nauty's arrays of a graph: vertices by colour, and which begin a colour.
struct Partition {
  std::vector<int> labels, ends;
};

Partition partition_of(const ColouredGraph& graph) {
  const int n = static_cast<int>(graph.colours.size());
  Partition out;
  out.labels.resize(n);
  for (int i = 0; i < n; ++i) out.labels[i] = i;
  std::stable_sort(out.labels.begin(), out.labels.end(),
                   [&](int a, int b) { return graph.colours[a] < graph.colours[b]; });
  for (int i = 0; i < n; ++i)
    out.ends.push_back(
        i + 1 < n && graph.colours[out.labels[i]] == graph.colours[out.labels[i + 1]] ? 1 : 0);
  return out;
}

/// The canonical place of each vertex.
std::vector<int> canonical_places(const ColouredGraph& graph, Partition& partition) {
  const int n = static_cast<int>(graph.colours.size());
  std::vector<std::size_t> first(n, 0);
  std::vector<int> degree(n, 0), edges(2 * graph.edges.size());
  for (const auto& [a, b] : graph.edges) {
    ++degree[a];
    ++degree[b];
  }
  for (int v = 1; v < n; ++v) first[v] = first[v - 1] + static_cast<std::size_t>(degree[v - 1]);
  std::vector<std::size_t> end = first;
  for (const auto& [a, b] : graph.edges) {
    edges[end[a]++] = b;
    edges[end[b]++] = a;
  }
  sparsegraph given;
  SG_INIT(given);
  given.nv = n;
  given.nde = edges.size();
  given.v = first.data();
  given.d = degree.data();
  given.e = edges.data();
  given.vlen = given.dlen = static_cast<std::size_t>(n);
  given.elen = edges.size();
  static DEFAULTOPTIONS_SPARSEGRAPH(kDefaults);
  optionblk options = kDefaults;
  options.getcanon = TRUE;
  options.defaultptn = FALSE;
  statsblk stats;
  std::vector<int> orbits(n);
  sparsegraph canonical;
  SG_INIT(canonical);
  static std::mutex one_at_a_time;
  {
    const std::lock_guard lock(one_at_a_time);
    sparsenauty(&given, partition.labels.data(), partition.ends.data(), orbits.data(), &options,
                &stats, &canonical);
  }
  SG_FREE(canonical);
  std::vector<int> place(n);
  for (int i = 0; i < n; ++i) place[partition.labels[i]] = i;
  return place;
}

/// Colours in canonical order, then the edges.
std::vector<int> form_of(const ColouredGraph& graph) {
  std::vector<int> form{static_cast<int>(graph.colours.size())};
  if (graph.colours.empty()) return form;
  Partition partition = partition_of(graph);
  for (const int v : partition.labels)
    form.insert(form.end(), graph.colours[v].begin(), graph.colours[v].end());
  const std::vector<int> place = canonical_places(graph, partition);
  std::vector<std::pair<int, int>> edges;
  for (const auto& [a, b] : graph.edges) edges.push_back(std::minmax(place[a], place[b]));
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges) {
    form.push_back(a);
    form.push_back(b);
  }
  return form;
}

CanonicalKey key_of(const std::vector<int>& form) {
  KeyHash hash;
  for (const int word : form) hash.add(word);
  return hash.key();
}

}  // namespace

std::vector<int> canonical_form(const Assembly& assembly, const std::vector<PartType>& types,
                                bool symmetries) {
  return form_of(graph_of(assembly, types, nullptr, symmetries));
}

CanonicalKey canonical_key(const Assembly& assembly, const std::vector<PartType>& types,
                           bool symmetries) {
  return key_of(canonical_form(assembly, types, symmetries));
}

CanonicalKey canonical_key(const Assembly& assembly, const std::vector<PartType>& types,
                           const PartSet& parts, bool symmetries) {
  return key_of(form_of(graph_of(assembly, types, &parts, symmetries)));
}

CanonicalKey canonical_key(const Assembly& assembly, const std::vector<PartType>& types,
                           const PartSet& parts, std::span<const int> boundary,
                           std::span<const int> colours, bool symmetries) {
  return key_of(form_of(graph_of(assembly, types, &parts, symmetries, boundary, colours)));
}

}  // namespace geoprior::assembly
