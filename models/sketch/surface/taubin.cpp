#include "models/sketch/surface/taubin.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "models/sketch/surface/cotangent_weights.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kSmoothedTogether = 1024;
constexpr std::array<std::string_view, 2> kTaubinWeightNames{"umbrella", "cotangent"};

/// Neighbours of the vertices that move, in compressed rows, with weights that add up to 1.
struct Averages {
  std::vector<int> begin{0};
  std::vector<int> neighbour;
  std::vector<double> weight;
};

/// Appends the row of a vertex from the entries of its column; none when no weight is above zero.
void append_row(const Eigen::SparseMatrix<double>& weights, int v, const std::vector<bool>& border,
                bool along_border, Averages& averages) {
  const auto counts = [&](int j) { return j != v && !(along_border && border[v] && !border[j]); };
  double sum = 0;
  for (Eigen::SparseMatrix<double>::InnerIterator it(weights, v); it; ++it)
    if (counts(static_cast<int>(it.row()))) sum += std::max(it.value(), 0.0);
  for (Eigen::SparseMatrix<double>::InnerIterator it(weights, v); it && sum > 0; ++it) {
    if (!counts(static_cast<int>(it.row())) || !(it.value() > 0)) continue;
    averages.neighbour.push_back(static_cast<int>(it.row()));
    averages.weight.push_back(it.value() / sum);
  }
}

/// Neighbours along ridges, of each vertex.
std::vector<std::vector<int>> ridge_neighbours(const std::vector<Edge>& ridges, int vertices) {
  std::vector<std::vector<int>> neighbours(vertices);
  for (const auto& [a, b] : ridges) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  return neighbours;
}

/// Appends the row of a vertex of ridges; none at their ends and branches.
void append_ridge_row(const std::vector<int>& along, Averages& averages) {
  if (along.size() != 2) return;
  averages.neighbour.insert(averages.neighbour.end(), along.begin(), along.end());
  averages.weight.insert(averages.weight.end(), 2, 0.5);
}

Averages averages_of(const TriMesh& mesh, const TaubinOptions& options,
                     const std::vector<Edge>& ridges) {
  Eigen::MatrixX3d corner_weights = Eigen::MatrixX3d::Ones(mesh.triangle_count(), 3);
  if (options.weight == NeighbourWeight::cotangent) corner_weights = corner_cotangents(mesh);
  Eigen::SparseMatrix<double> weights =
      -cotangent_stiffness(mesh.F, corner_weights, mesh.vertex_count());
  if (options.weight == NeighbourWeight::umbrella) {
    // An edge of two triangles counts as one of the border.
    weights = weights.unaryExpr([](double w) { return w > 0 ? 1.0 : w; });
  }
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  const std::vector<std::vector<int>> ridge = ridge_neighbours(ridges, mesh.vertex_count());
  Averages averages;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!ridge[v].empty())
      append_ridge_row(ridge[v], averages);
    else if (!(options.fixed_border && border[v]))
      append_row(weights, v, border, !options.fixed_border, averages);
    averages.begin.push_back(static_cast<int>(averages.neighbour.size()));
  }
  return averages;
}

/// x + factor L x
void filter_step(const Averages& averages, double factor, const Eigen::Matrix3Xd& x,
                 Eigen::Matrix3Xd& filtered) {
  parallel_blocks(x.cols(), kSmoothedTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Index i = v;
      Eigen::Vector3d change = Eigen::Vector3d::Zero();
      for (int e = averages.begin[v]; e < averages.begin[v + 1]; ++e)
        change += averages.weight[e] * (x.col(averages.neighbour[e]) - x.col(i));
      filtered.col(i) = x.col(i) + factor * change;
    }
  });
}

}  // namespace

void describe(OptionVisitor& v, TaubinOptions& options) {
  v.value("lambda", options.lambda, {.doc = "factor of the step that shrinks", .min = 0, .max = 1});
  v.value("mu", options.mu, {.doc = "factor of the step that swells", .min = -2, .max = 0});
  v.value("double_steps", options.double_steps,
          {.doc = "pairs of a shrinking and a swelling step", .min = 0, .max = 100000});
  describe_choice(v, "weight", options.weight, kTaubinWeightNames,
                  {.doc = "how much neighbours count: all the same, or by cotangents"});
  v.value("fixed_border", options.fixed_border,
          {.doc = "whether vertices of the border stay; otherwise neighbours along it count"});
}

Eigen::MatrixX3d taubin_smoothed(const TriMesh& mesh, const TaubinOptions& options,
                                 const std::vector<Edge>& ridges) {
  if (!(options.lambda > 0)) throw Error("lambda is not positive", "Taubin smoothing", "above 0");
  if (!(options.mu < -options.lambda))
    throw Error("mu does not undo what lambda shrinks", "Taubin smoothing", "below -lambda");
  if (options.double_steps < 0)
    throw Error("the number of double steps is negative", "Taubin smoothing", "0 or more");
  const Averages averages = averages_of(mesh, options, ridges);
  Eigen::Matrix3Xd x = mesh.V.transpose(), between(3, mesh.V.rows());
  for (int step = 0; step < options.double_steps; ++step) {
    filter_step(averages, options.lambda, x, between);
    filter_step(averages, options.mu, between, x);
  }
  return x.transpose();
}

}  // namespace geoprior::sketch
