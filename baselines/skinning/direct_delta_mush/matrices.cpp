#include "baselines/skinning/direct_delta_mush/matrices.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "baselines/skinning/direct_delta_mush/implicit_smoothing.h"
#include "baselines/skinning/shared/influences.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

/// Share of a vertex's covariance that always turns with its strongest joint.
constexpr double kIsotropicShare = 1e-6;

using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Elements of the symmetric u u' of a homogeneous position, upper triangle by rows.
constexpr int kProducts = 10;

Eigen::Matrix<double, 1, kProducts> products(const Eigen::RowVector3d& u) {
  Eigen::Matrix<double, 1, kProducts> result;
  result << u.x() * u.x(), u.x() * u.y(), u.x() * u.z(), u.x(), u.y() * u.y(), u.y() * u.z(), u.y(),
      u.z() * u.z(), u.z(), 1;
  return result;
}

/// Psi of one vertex and joint, from its ten smoothed products.
struct Psi {
  Eigen::Matrix3d second;
  Eigen::Vector3d first;
  double weight;
};

template <class Row>
Psi psi_of(const Row& s) {
  Psi psi;
  psi.second << s(0), s(1), s(2), s(1), s(4), s(5), s(2), s(5), s(7);
  psi.first << s(3), s(6), s(8);
  psi.weight = s(9);
  return psi;
}

/// T Psi T' with the translation by -p.
Psi relative_to(const Eigen::Vector3d& p, const Psi& psi) {
  return {psi.second - psi.first * p.transpose() - p * psi.first.transpose() +
              psi.weight * p * p.transpose(),
          psi.first - psi.weight * p, psi.weight};
}

/// Weights, one column a joint.
Columns dense_weights(const RiggedMesh& rig) {
  Columns dense = Columns::Zero(rig.mesh.vertex_count(), rig.skeleton.size());
  for (int i = 0; i < rig.mesh.vertex_count(); ++i) {
    for (SkinWeights::InnerIterator w(rig.weights, i); w; ++w) dense(i, w.col()) = w.value();
  }
  return dense;
}

/// Smooths columns in groups that are as wide as ten products, groups in parallel.
void smooth_columns(const ImplicitSmoothing& smoothing, Columns& columns) {
  const std::size_t groups = (columns.cols() + kProducts - 1) / kProducts;
  parallel_blocks(groups, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const Eigen::Index first = static_cast<Eigen::Index>(g) * kProducts;
      const Eigen::Index count = std::min<Eigen::Index>(kProducts, columns.cols() - first);
      Columns group = columns.middleCols(first, count);
      smoothing.apply(group);
      columns.middleCols(first, count) = group;
    }
  });
}

/// Builds the matrices of one rig, step by step.
class MatrixBuilder {
 public:
  MatrixBuilder(const RiggedMesh& rig, const DirectDeltaMushOptions& options)
      : rig_(rig),
        options_(options),
        origin_(rig.mesh.V.colwise().mean()),
        shape_smoothing_(rig.mesh, options.lambda, options.iterations) {}

  DirectDeltaMushMatrices build() {
    smooth_everything();
    choose_influences();
    add_shapes_of_joints();
    finish_strongest();
    result_.smoothed.rowwise() += origin_;
    return std::move(result_);
  }

 private:
  /// Smoothed weights, and the smoothed products of all joints together.
  void smooth_everything() {
    shape_weights_ = carried_weights_ = dense_weights(rig_);
    smooth_columns(shape_smoothing_, shape_weights_);
    smooth_columns(ImplicitSmoothing(rig_.mesh, options_.kappa, options_.iterations),
                   carried_weights_);
    const int n = rig_.mesh.vertex_count();
    whole_.resize(n, kProducts);
    for (int i = 0; i < n; ++i) whole_.row(i) = products(rig_.mesh.V.row(i) - origin_);
    shape_smoothing_.apply(whole_);
    result_.smoothed.resize(n, 3);
    for (int i = 0; i < n; ++i) {
      const Psi psi = psi_of(whole_.row(i));
      result_.smoothed.row(i) = psi.first.transpose() / psi.weight;
    }
  }

  [[nodiscard]] double share(int vertex, int joint) const {
    return (1 - options_.alpha) * shape_weights_(vertex, joint) +
           options_.alpha * carried_weights_(vertex, joint);
  }

  /// Entries of every vertex, without shapes yet; the strongest first.
  void choose_influences() {
    result_.offset.push_back(0);
    entries_of_joint_.resize(rig_.skeleton.size());
    for (int i = 0; i < rig_.mesh.vertex_count(); ++i) {
      int strongest = 0;
      for (int j = 1; j < rig_.skeleton.size(); ++j) {
        if (share(i, j) > share(i, strongest)) strongest = j;
      }
      result_.matrices.push_back({.joint = strongest});
      for (int j = 0; j < rig_.skeleton.size(); ++j) {
        if (j == strongest ||
            std::max(shape_weights_(i, j), carried_weights_(i, j)) < options_.smallest_influence)
          continue;
        entries_of_joint_[j].push_back({i, result_.matrices.size()});
        result_.matrices.push_back({.joint = j, .share = share(i, j)});
      }
      result_.offset.push_back(result_.matrices.size());
    }
  }

  /// Shapes and offsets of all entries but the strongest, joint by joint.
  void add_shapes_of_joints() {
    parallel_blocks(entries_of_joint_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        if (entries_of_joint_[j].empty()) continue;
        const Columns smoothed = smoothed_products(static_cast<int>(j));
        for (const auto& [vertex, entry] : entries_of_joint_[j]) {
          const Psi psi = relative_to(result_.smoothed.row(vertex), psi_of(smoothed.row(vertex)));
          result_.matrices[entry].shape = (1 - options_.alpha) * psi.second;
          result_.matrices[entry].offset = (1 - options_.alpha) * psi.first;
        }
      }
    });
  }

  [[nodiscard]] Columns smoothed_products(int joint) const {
    Columns columns = Columns::Zero(rig_.mesh.vertex_count(), kProducts);
    for (int i = 0; i < rig_.mesh.vertex_count(); ++i) {
      const double w = rig_.weights.coeff(i, joint);
      if (w > 0) columns.row(i) = w * products(rig_.mesh.V.row(i) - origin_);
    }
    shape_smoothing_.apply(columns);
    return columns;
  }

  /// The strongest joint has what the others leave.
  void finish_strongest() {
    for (int i = 0; i < rig_.mesh.vertex_count(); ++i) {
      const std::size_t begin = result_.offset[i];
      const std::size_t end = result_.offset[static_cast<std::size_t>(i) + 1];
      JointMatrix& strongest = result_.matrices[begin];
      const Eigen::Matrix3d covariance =
          (1 - options_.alpha) * relative_to(result_.smoothed.row(i), psi_of(whole_.row(i))).second;
      strongest.shape = covariance;
      strongest.share = 1;
      for (std::size_t e = begin + 1; e < end; ++e) {
        strongest.shape -= result_.matrices[e].shape;
        strongest.offset -= result_.matrices[e].offset;
        strongest.share -= result_.matrices[e].share;
      }
      strongest.shape.diagonal().array() += kIsotropicShare * covariance.trace();
    }
  }

  /// An entry of the result.
  struct Entry {
    int vertex;
    std::size_t index;
  };

  const RiggedMesh& rig_;
  const DirectDeltaMushOptions& options_;
  Eigen::RowVector3d origin_;  ///< positions are taken from here: fewer digits cancel
  ImplicitSmoothing shape_smoothing_;
  Columns shape_weights_;    ///< B w
  Columns carried_weights_;  ///< C w = w'
  Columns whole_;            ///< sum over the joints of the smoothed products
  std::vector<std::vector<Entry>> entries_of_joint_;
  DirectDeltaMushMatrices result_;
};

void check(const DirectDeltaMushOptions& options) {
  const auto require = [](bool holds, const char* what, const char* allowed) {
    if (!holds) throw Error(std::string(what) + " of direct delta mush", "", allowed);
  };
  require(options.iterations >= 1, "iterations", ">= 1");
  require(options.lambda > 0 && std::isfinite(options.lambda), "lambda", "> 0");
  require(options.kappa >= 0 && options.kappa <= options.lambda, "kappa", "0 to lambda");
  require(options.alpha >= 0 && options.alpha < 1, "alpha", "0 to below 1");
  require(options.smallest_influence >= 0 && options.smallest_influence <= 0.1,
          "smallest_influence", "0 to 0.1");
}

}  // namespace

void describe(OptionVisitor& v, DirectDeltaMushOptions& options) {
  v.value("iterations", options.iterations,
          {.doc = "p, number of implicit smoothing steps", .min = 1, .max = 1000});
  v.value(
      "lambda", options.lambda,
      {.doc = "length of a smoothing step of the shape around a vertex", .min = 1e-3, .max = 1e3});
  v.value("kappa", options.kappa,
          {.doc = "length of a smoothing step of the weights that carry a vertex; at most lambda",
           .min = 0,
           .max = 1e3});
  v.value(
      "alpha", options.alpha,
      {.doc = "share of the smoothed weights in the translation; below 1", .min = 0, .max = 0.999});
  v.value("smallest_influence", options.smallest_influence,
          {.doc = "smoothed weight below which an influence moves with the strongest joint",
           .min = 0,
           .max = 0.1});
}

DirectDeltaMushMatrices direct_delta_mush_matrices(const RiggedMesh& rig,
                                                   const DirectDeltaMushOptions& options) {
  check(options);
  require_skinnable(rig);
  return MatrixBuilder(rig, options).build();
}

}  // namespace geoprior::skinning
