#include "models/assembly/graph/ported_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::assembly {
namespace {

std::string part_title(const AssemblySet& set, const Assembly& model, int part) {
  return "part " + std::to_string(part) + " '" + set.types[model.parts[part].type].label + "'";
}

void require_port(const AssemblySet& set, const Assembly& model, PortRef ref,
                  const std::string& where) {
  const int parts = static_cast<int>(model.parts.size());
  if (ref.part < 0 || ref.part >= parts)
    throw Error("joins part " + std::to_string(ref.part), where,
                "0 to " + std::to_string(parts - 1));
  const auto& ports = set.types[model.parts[ref.part].type].ports;
  if (ref.port < 0 || ref.port >= static_cast<int>(ports.size()))
    throw Error(
        "joins port " + std::to_string(ref.port) + " of " + part_title(set, model, ref.part), where,
        ports.empty() ? "none, the part has no ports" : "0 to " + std::to_string(ports.size() - 1));
}

void require_valid_connections(const AssemblySet& set, const Assembly& model) {
  std::map<PortRef, std::size_t> users;
  for (std::size_t c = 0; c < model.connections.size(); ++c) {
    const std::string where = "model '" + model.name + "', connection " + std::to_string(c);
    for (const PortRef& end : {model.connections[c].a, model.connections[c].b}) {
      require_port(set, model, end, where);
      const auto [user, is_new] = users.emplace(end, c);
      if (is_new) continue;
      const std::string port = "port '" +
                               set.types[model.parts[end.part].type].ports[end.port].name +
                               "' of " + part_title(set, model, end.part);
      if (user->second == c) throw Error(port + " is joined with itself", where);
      throw Error(port + " is used by connection " + std::to_string(user->second) + ", too", where);
    }
  }
}

/// Two parts of one type whose poses agree to round-off of the file.
void require_apart(const AssemblySet& set, const Assembly& model) {
  constexpr double kSame = 1e-6;  // m, and 1 for the entries of the rotation
  std::vector<int> order(model.parts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto at = [&](int i) { return model.parts[i].pose.translation(); };
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(at(a).x(), a) < std::pair(at(b).x(), b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && at(order[j]).x() - at(order[i]).x() <= kSame;
         ++j) {
      const PlacedPart &a = model.parts[order[i]], &b = model.parts[order[j]];
      if (a.type != b.type || (a.pose.matrix() - b.pose.matrix()).cwiseAbs().maxCoeff() > kSame)
        continue;
      throw Error(
          "is on the place of " + part_title(set, model, std::min(order[i], order[j])),
          "model '" + model.name + "', " + part_title(set, model, std::max(order[i], order[j])));
    }
}

}  // namespace

void require_valid(const AssemblySet& set) {
  std::set<std::string> labels;
  for (const PartType& type : set.types)
    if (!labels.insert(type.label).second)
      throw Error("is the label of two kinds of parts", "part '" + type.label + "'");
  for (const Assembly& model : set.models) {
    for (std::size_t i = 0; i < model.parts.size(); ++i) {
      const PlacedPart& part = model.parts[i];
      const std::string where = "model '" + model.name + "', part " + std::to_string(i);
      if (part.type < 0 || part.type >= static_cast<int>(set.types.size()))
        throw Error("is of type " + std::to_string(part.type), where,
                    "0 to " + std::to_string(set.types.size() - 1));
      if (!part.pose.matrix().allFinite()) throw Error("has a pose that is not finite", where);
    }
    require_valid_connections(set, model);
    require_apart(set, model);
  }
}

Links::Links(const Assembly& assembly, const std::vector<PartType>& types) {
  first_.reserve(assembly.parts.size() + 1);
  first_.push_back(0);
  for (const PlacedPart& part : assembly.parts)
    first_.push_back(first_.back() + static_cast<int>(types[part.type].ports.size()));
  connection_.assign(first_.back(), -1);
  for (std::size_t c = 0; c < assembly.connections.size(); ++c)
    for (const PortRef& end : {assembly.connections[c].a, assembly.connections[c].b})
      connection_[first_[end.part] + end.port] = static_cast<int>(c);
}

PortRef other_end(const Connection& connection, PortRef port) {
  return connection.a == port ? connection.b : connection.a;
}

Components components(const Assembly& assembly) {
  const int n = static_cast<int>(assembly.parts.size());
  DisjointSets sets(n);
  for (const Connection& c : assembly.connections) sets.join(c.a.part, c.b.part);
  Components out;
  out.of_part.resize(n);
  std::vector<int> number(n, -1);
  for (int part = 0; part < n; ++part) {
    int& k = number[sets.find(part)];
    if (k < 0) k = out.count++;
    out.of_part[part] = k;
  }
  return out;
}

Pose port_pose(const Assembly& assembly, const std::vector<PartType>& types, PortRef port) {
  const PlacedPart& part = assembly.parts[port.part];
  return part.pose * types[part.type].ports[port.port].frame;
}

std::vector<Misfit> joint_misfits(const Assembly& assembly, const std::vector<PartType>& types) {
  std::vector<Misfit> out;
  out.reserve(assembly.connections.size());
  for (const Connection& c : assembly.connections)
    out.push_back(misfit(port_pose(assembly, types, c.a), port_pose(assembly, types, c.b)));
  return out;
}

void place_parts(Assembly& assembly, const std::vector<PartType>& types) {
  const Links links(assembly, types);
  std::vector<char> placed(assembly.parts.size(), 0);
  std::vector<int> queue;
  for (std::size_t root = 0; root < placed.size(); ++root) {
    if (placed[root]) continue;
    placed[root] = 1;
    queue.assign(1, static_cast<int>(root));
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const int part = queue[next];
      for (int port = 0; port < links.port_count(part); ++port) {
        const int c = links.connection({part, port});
        if (c < 0) continue;
        const PortRef there = other_end(assembly.connections[c], {part, port});
        if (placed[there.part]) continue;
        placed[there.part] = 1;
        PlacedPart& other = assembly.parts[there.part];
        other.pose = mated(port_pose(assembly, types, {part, port})) *
                     types[other.type].ports[there.port].frame.inverse();
        queue.push_back(there.part);
      }
    }
  }
}

}  // namespace geoprior::assembly
