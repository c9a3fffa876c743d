#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "models/sketch/flatten/flat_triangles.h"

namespace geoprior::sketch {

struct RigidLayoutOptions {
  int iterations = 300;     ///< most local and global steps
  double tolerance = 1e-9;  ///< it stops when the energy changes by less than this, relative to it
  double least_energy = 1e-20;     ///< … or falls below this, relative to the area
  int mixing = 6;                  ///< window of the Anderson acceleration; 0: plain steps
  int length_rounds = 8;           ///< most linearisations of kept lengths
  double length_tolerance = 1e-4;  ///< of them, relative, at which there are no more
};

struct RigidLayoutReport {
  int iterations = 0;
  double energy = 0;        ///< m^2, of the result
  double length_error = 0;  ///< largest of kept lengths, relative
};

/// A chain of edges whose length in all is kept: one side of a seam, which the other is sewn to.
struct KeptLength {
  std::vector<int> vertices;
  double length = 0;  ///< m
};

/// Lays triangles into the plane so that each keeps its size and shape as well as it can (as-rigid-
/// as-possible).
///
///   E(z, r) = sum_t sum_k w_k |z_{k+1} - z_k - r_t e_k|^2 / 2,   |r_t| = 1,
///
/// e_k the edges of triangle t laid flat by itself, r_t its turn, w_k half the cotangent of the
/// angle opposite to the edge, at least -1; without clamps E = sum_t area_t |J_t - R_t|^2 / 2 with
/// J_t the linear part of the map. The local step is closed form, r_t = s / |s| with
/// s = sum_k w_k conj(e_k) (z_{k+1} - z_k); the global step solves one real system that is
/// factorised once. Each of them lowers E; Anderson acceleration makes them fewer.
///
/// Kept lengths are held, E being lowered under them: every step is followed by corrections of
/// least energy that restore them, whose directions are made anew a few times. The few rows cost
/// back substitutions, no factorisation. Only a chain's length in all is held: how the strain
/// spreads along it is left to E.
///
/// Nothing keeps triangles from turning over: ask `flipped_triangles`.
/// Source: Liu, Zhang, Xu, Gotsman, Gortler 2008; Sorkine and Alexa 2007; Peng et al. 2018.
class RigidLayout {
 public:
  /// Both are referred to. Every vertex must belong to a triangle, all must be connected.
  RigidLayout(std::span<const FlatTriangle> triangles, const Eigen::MatrixX3i& F, int vertex_count);
  ~RigidLayout();
  RigidLayout(RigidLayout&&) noexcept;
  RigidLayout& operator=(RigidLayout&&) noexcept;

  /// @param z  where to begin; replaced
  RigidLayoutReport improve(Eigen::VectorXcd& z, const RigidLayoutOptions& options) const;
  /// Brings chains of edges to their lengths, and lowers E under them.
  /// @param z  where to begin: what `improve` ended with; replaced
  RigidLayoutReport hold(Eigen::VectorXcd& z, std::span<const KeptLength> kept,
                         const RigidLayoutOptions& options) const;
  /// The energy with the best turns (m^2).
  [[nodiscard]] double energy(const Eigen::VectorXcd& z) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior::sketch
