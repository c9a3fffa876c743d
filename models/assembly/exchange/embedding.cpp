#include "models/assembly/exchange/embedding.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/disjoint_sets.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, JointTolerance& options) {
  v.value("translation", options.translation,
          {.doc = "most that two joined ports may be apart", .unit = "m", .min = 0});
  v.value("angle_deg", options.angle_deg,
          {.doc = "most that two joined ports may be turned against each other",
           .unit = "deg",
           .min = 0,
           .max = 180});
}

bool within(const Misfit& misfit, const JointTolerance& tolerance) {
  return misfit.translation <= tolerance.translation &&
         misfit.angle * 180 / std::numbers::pi <= tolerance.angle_deg;
}

Misfit largest(const std::vector<Misfit>& misfits) {
  Misfit out;
  for (const Misfit& m : misfits) {
    out.translation = std::max(out.translation, m.translation);
    out.angle = std::max(out.angle, m.angle);
  }
  return out;
}

Misfit seam_residual(const Assembly& host, const Assembly& donor,
                     const std::vector<PartType>& types, const Replacement& replacement,
                     const std::vector<int>& outside) {
  const Substructure &removed = replacement.removed, &inserted = replacement.inserted;
  const std::span<const int> match = replacement.match;
  Misfit out;
  const auto outer = [&](std::size_t k) {
    return port_pose(host, types,
                     outside_end(host.connections[removed.boundary[k]], removed.parts));
  };
  const auto inner = [&](std::size_t k) {
    return port_pose(donor, types,
                     inside_end(donor.connections[inserted.boundary[match[k]]], inserted.parts));
  };
  for (std::size_t k = 1; k < outside.size(); ++k) {
    const std::size_t first =
        std::find(outside.begin(), outside.end(), outside[k]) - outside.begin();
    if (first == k) continue;
    const Pose motion = mated(outer(first)) * inner(first).inverse();
    const Misfit m = misfit(outer(k), motion * inner(k));
    out.translation = std::max(out.translation, m.translation);
    out.angle = std::max(out.angle, m.angle);
  }
  return out;
}

namespace {

/// Pieces of a replaced assembly that move as one: components of all connections but the seams.
struct Pieces {
  DisjointSets sets;
  std::vector<int> sizes;

  explicit Pieces(const Replaced& replaced)
      : sets(static_cast<int>(replaced.assembly.parts.size())),
        sizes(replaced.assembly.parts.size(), 0) {
    std::vector<char> is_seam(replaced.assembly.connections.size(), 0);
    for (const int seam : replaced.seams) is_seam[seam] = 1;
    for (std::size_t c = 0; c < is_seam.size(); ++c)
      if (!is_seam[c])
        sets.join(replaced.assembly.connections[c].a.part, replaced.assembly.connections[c].b.part);
    for (std::size_t i = 0; i < sizes.size(); ++i) ++sizes[sets.find(static_cast<int>(i))];
  }
};

}  // namespace

void embed(Replaced& replaced, const std::vector<PartType>& types) {
  Assembly& assembly = replaced.assembly;
  Pieces pieces(replaced);
  std::vector<char> placed(assembly.parts.size(), 0);
  int anchor = -1;
  for (const int seam : replaced.seams) {
    const int piece = pieces.sets.find(assembly.connections[seam].a.part);
    if (anchor < 0 || pieces.sizes[piece] > pieces.sizes[anchor]) anchor = piece;
  }
  if (anchor < 0) return;
  placed[anchor] = 1;
  // Every seam joins the copied piece with one that stays: the anchor's first seam places the
  // copied piece, the first one of each other piece that one.
  for (const bool of_anchor : {true, false})
    for (const int seam : replaced.seams) {
      const auto [outer, inner] = assembly.connections[seam];
      const int out_piece = pieces.sets.find(outer.part), in_piece = pieces.sets.find(inner.part);
      if ((out_piece == anchor) != of_anchor || placed[out_piece] == placed[in_piece]) continue;
      const bool moves_in = placed[out_piece] != 0;
      const PortRef from = moves_in ? outer : inner, to = moves_in ? inner : outer;
      const int moved = moves_in ? in_piece : out_piece;
      const Pose motion =
          mated(port_pose(assembly, types, from)) * port_pose(assembly, types, to).inverse();
      for (std::size_t i = 0; i < assembly.parts.size(); ++i)
        if (pieces.sets.find(static_cast<int>(i)) == moved)
          assembly.parts[i].pose = motion * assembly.parts[i].pose;
      placed[moved] = 1;
    }
}

namespace {

using Block6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& x) {
  Eigen::Matrix3d m;
  m << 0, -x.z(), x.y(), x.z(), 0, -x.x(), -x.y(), x.x(), 0;
  return m;
}

/// One joint's residual (translation, rotation vector), weighted, and its derivatives with respect
/// to small motions (translation, rotation about the part's origin) of the two parts.
struct JointEquation {
  int a = 0, b = 0;
  Vector6 residual;
  Block6 by_a, by_b;
};

JointEquation joint_equation(const Assembly& assembly, const std::vector<PartType>& types,
                             const Connection& c, double per_metre, double per_radian) {
  const Pose A = mated(port_pose(assembly, types, c.a)), B = port_pose(assembly, types, c.b);
  const Eigen::AngleAxisd turn(A.linear() * B.linear().transpose());
  JointEquation e;
  e.a = c.a.part;
  e.b = c.b.part;
  e.residual << per_metre * (A.translation() - B.translation()),
      per_radian * turn.angle() * turn.axis();
  const auto block = [&](const Eigen::Vector3d& arm) {
    Block6 m = Block6::Zero();
    m.topLeftCorner<3, 3>().diagonal().setConstant(per_metre);
    m.topRightCorner<3, 3>() = -per_metre * cross_matrix(arm);
    m.bottomRightCorner<3, 3>().diagonal().setConstant(per_radian);
    return m;
  };
  e.by_a = block(A.translation() - assembly.parts[e.a].pose.translation());
  e.by_b = -block(B.translation() - assembly.parts[e.b].pose.translation());
  return e;
}

void add_block(std::vector<Eigen::Triplet<double>>& triplets, int row, int column,
               const Block6& block) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (block(i, j) != 0) triplets.emplace_back(6 * row + i, 6 * column + j, block(i, j));
}

/// A step of Gauss-Newton; parts without an unknown stay.
Eigen::VectorXd gauss_newton_step(const Assembly& assembly, const std::vector<PartType>& types,
                                  const std::vector<int>& unknown, int unknowns, double per_metre,
                                  double per_radian) {
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::VectorXd residual(6 * assembly.connections.size());
  int row = 0;
  for (const Connection& c : assembly.connections) {
    const JointEquation e = joint_equation(assembly, types, c, per_metre, per_radian);
    if (unknown[e.a] >= 0) add_block(triplets, row, unknown[e.a], e.by_a);
    if (unknown[e.b] >= 0) add_block(triplets, row, unknown[e.b], e.by_b);
    residual.segment<6>(6 * row++) = e.residual;
  }
  Eigen::SparseMatrix<double> J(residual.size(), 6 * unknowns);
  J.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SparseMatrix<double> normal = J.transpose() * J;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  return -solver.solve(J.transpose() * residual);
}

void move_part(Pose& pose, const Vector6& step) {
  const Eigen::Vector3d turn = step.tail<3>();
  if (turn.norm() > 0)
    pose.linear() =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * pose.linear();
  pose.translation() += step.head<3>();
}

}  // namespace

Misfit relax(Assembly& assembly, const std::vector<PartType>& types,
             const JointTolerance& tolerance) {
  constexpr int kSteps = 6;
  constexpr double kLeastStep = 1e-10;
  constexpr double kLeastTolerance = 1e-9;
  const double per_metre = 1 / std::max(tolerance.translation, kLeastTolerance);
  const double per_radian =
      1 / std::max(tolerance.angle_deg * std::numbers::pi / 180, kLeastTolerance);
  const Components hanging = components(assembly);
  std::vector<int> unknown(assembly.parts.size(), -1);
  std::vector<char> has_fixed(hanging.count, 0);
  int unknowns = 0;
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    char& fixed = has_fixed[hanging.of_part[i]];
    if (fixed) unknown[i] = unknowns++;
    fixed = 1;
  }
  for (int step = 0; step < kSteps && unknowns > 0; ++step) {
    const Eigen::VectorXd x =
        gauss_newton_step(assembly, types, unknown, unknowns, per_metre, per_radian);
    if (!x.allFinite()) break;
    for (std::size_t i = 0; i < unknown.size(); ++i)
      if (unknown[i] >= 0) move_part(assembly.parts[i].pose, x.segment<6>(6 * unknown[i]));
    if (x.lpNorm<Eigen::Infinity>() < kLeastStep) break;
  }
  return largest(joint_misfits(assembly, types));
}

}  // namespace geoprior::assembly
