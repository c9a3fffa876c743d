#pragma once

#include <compare>
#include <string>
#include <vector>

#include "models/assembly/graph/part_type.h"

namespace geoprior::assembly {

/// A port of a part of an assembly.
struct PortRef {
  int part = 0;
  int port = 0;
  auto operator<=>(const PortRef&) const = default;
};

/// Two ports that are joined.
struct Connection {
  PortRef a, b;
};

struct PlacedPart {
  int type = 0;  ///< in the catalogue
  Pose pose = Pose::Identity();
};

/// A ported graph: parts and which of their ports are joined. Ports that no connection names are
/// open.
struct Assembly {
  std::string name;
  std::vector<PlacedPart> parts;
  std::vector<Connection> connections;
};

/// Kinds of parts, and models made of them.
struct AssemblySet {
  std::vector<PartType> types;
  std::vector<Assembly> models;
};

/// @throws Error  naming model and element: a type that is not there, a port that its type does not
///                have, a port that two connections use, a port joined with itself, poses that are
///                not finite, two parts of one type at one place; a label that two types share
void require_valid(const AssemblySet& set);

/// For each port of each part what it is joined with.
class Links {
 public:
  Links(const Assembly& assembly, const std::vector<PartType>& types);
  /// Index of the connection of a port; -1 for an open one.
  [[nodiscard]] int connection(PortRef port) const {
    return connection_[first_[port.part] + port.port];
  }
  [[nodiscard]] int port_count(int part) const { return first_[part + 1] - first_[part]; }

 private:
  std::vector<int> first_;
  std::vector<int> connection_;
};

/// The end of a connection that is not `port`.
PortRef other_end(const Connection& connection, PortRef port);

/// Parts that hang together, one number a part from 0 on, numbered by their first part.
struct Components {
  std::vector<int> of_part;
  int count = 0;
};
Components components(const Assembly& assembly);

/// Pose of a port in the world.
Pose port_pose(const Assembly& assembly, const std::vector<PartType>& types, PortRef port);

/// Misfit of each connection, as the parts are placed.
std::vector<Misfit> joint_misfits(const Assembly& assembly, const std::vector<PartType>& types);

/// Places the parts from the first of each component on, breadth first: each where its port meets
/// the port it was reached by. Connections that this did not use may not close (`joint_misfits`).
void place_parts(Assembly& assembly, const std::vector<PartType>& types);

}  // namespace geoprior::assembly
