#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/assembly/exchange/embedding.h"
#include "models/assembly/graph/ported_graph.h"

namespace geoprior::assembly {

/// "label at most n times".
struct PartLimit {
  std::string label;
  int most = 0;
};
void describe(OptionVisitor& v, PartLimit& options);

/// "n to m parts of these labels": entries, exits.
struct PartCount {
  std::vector<std::string> labels;
  int least = 1;
  int most = 1000;
};
void describe(OptionVisitor& v, PartCount& options);

/// An axis-aligned box (m).
struct Bounds {
  std::array<double, 3> low{-1, -1, -1};
  std::array<double, 3> high{1, 1, 1};
};
void describe(OptionVisitor& v, Bounds& options);

/// What makes an assembly a valid one. Absent rules hold.
struct Rules {
  JointTolerance tolerance;
  bool relax = false;                 ///< spread misfits before they are held against the tolerance
  std::vector<std::string> grounded;  ///< parts of these labels end on the floor z = 0
  double ground_tolerance = 1e-3;     ///< m
  std::optional<PartCount> entries;
  std::optional<PartCount> exits;
  std::optional<double> rise;  ///< m: most that a ball's way may rise
  bool collisions = true;      ///< parts that are not joined may not meet
  double clearance = 1e-3;     ///< m: boxes are shrunk by it before they are tried
  std::vector<PartLimit> bill;
  int parts = 100000;  ///< most parts
  bool connected = true;
  std::optional<Bounds> box;  ///< that the parts' boxes stay in
};
void describe(OptionVisitor& v, Rules& options);

/// The filters in the order in which they are tried.
enum class Filter { bill, counts, connected, closure, ground, box, way, collision, none };
std::string filter_name(Filter filter);

/// Lifts or lowers the assembly so that the lowest of its grounded parts is on the floor: where it
/// stands is not for a replacement to say, whose larger piece may have lost what it stood on.
void put_on_floor(Assembly& assembly, const std::vector<PartType>& types, const Rules& rules);

/// The first filter that an assembly does not pass; `none` for a valid one. The assembly is
/// embedded; where `rules.relax` is set its poses are relaxed first.
Filter first_broken(Assembly& assembly, const std::vector<PartType>& types, const Rules& rules);

/// The filters that need no poses: bill, counts, connected.
Filter first_broken_by_graph(const Assembly& assembly, const std::vector<PartType>& types,
                             const Rules& rules);

/// A ball's ways from an entry: poly-lines through ports, to where nothing goes on.
struct BallWay {
  std::vector<Eigen::Vector3d> points;  ///< in the world
  int last_part = 0;
  bool ends_inside = false;  ///< at the end of a way that ends in its part; false: at an open port
};
std::vector<BallWay> ball_ways(const Assembly& assembly, const std::vector<PartType>& types,
                               int entry_part);

/// Most that a poly-line rises above its lowest point so far (m).
double largest_rise(const std::vector<Eigen::Vector3d>& points);

/// Lowest z of a part's boxes and mesh in the world.
double lowest_point(const PartType& type, const Pose& pose);

/// Whether two boxes, each shrunk by `shrink`, meet: separating axes (Gottschalk et al. 1996).
bool boxes_meet(const Box& a, const Pose& a_pose, const Box& b, const Pose& b_pose, double shrink);

}  // namespace geoprior::assembly
