#include "baselines/fluid/liquid/pressure/pressure.h"

#include <algorithm>
#include <cmath>

#include "baselines/fluid/liquid/pressure/incomplete_cholesky.h"
#include "baselines/fluid/liquid/pressure/multigrid.h"
#include "baselines/fluid/liquid/pressure/preconditioner.h"
#include "baselines/fluid/liquid/pressure/system.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kPressureLayers = 2;  ///< layers of cells of a parallel block

/// One call: what was given, and how neighbours are looked up.
struct Problem {
  const GridShape& shape;
  const SolidFractions& solids;
  const ScalarGrid& liquid;
  const ScalarGrid* target;
  double smallest_theta;

  /// Offset to the neighbour on an axis in the list of cells.
  [[nodiscard]] std::size_t stride(int axis) const {
    const std::size_t nx = shape.cells.x();
    return axis == 0 ? 1 : axis == 1 ? nx : nx * shape.cells.y();
  }
  [[nodiscard]] std::size_t face(int axis, const Eigen::Vector3i& at, int upper) const {
    Eigen::Vector3i i = at;
    i[axis] += upper;
    return solids.open[axis].index(i.x(), i.y(), i.z());
  }
  [[nodiscard]] Eigen::Vector3i cell(std::size_t index) const {
    const std::size_t nx = shape.cells.x(), ny = shape.cells.y();
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / (nx * ny))};
  }
  /// Share of the way from a liquid centre to the air's centre that is liquid.
  [[nodiscard]] double theta(std::size_t liquid_cell, std::size_t air_cell) const {
    const double inside = liquid.values[liquid_cell], outside = liquid.values[air_cell];
    return std::max(inside / (inside - outside), smallest_theta);
  }
  /// Share of a cell, from its liquid centre towards an open side of the domain, that is liquid: at
  /// most a half, since the surface lies at the border at the latest.
  [[nodiscard]] double border_theta(std::size_t liquid_cell) const {
    const double inside = -static_cast<double>(liquid.values[liquid_cell]) / shape.cell;
    return std::clamp(inside, smallest_theta, 0.5);
  }
};

void for_cell_layers(const GridShape& shape, BlockBody body) {
  parallel_blocks(shape.cells.z(), kPressureLayers, body);
}

bool any_open_face(const Problem& problem, const Eigen::Vector3i& at) {
  for (int a = 0; a < 3; ++a)
    for (int upper = 0; upper < 2; ++upper)
      if (problem.solids.open[a].values[problem.face(a, at, upper)] > 0) return true;
  return false;
}

void mark_liquid(const Problem& problem, std::vector<std::uint8_t>& marked) {
  const Eigen::Vector3i n = problem.shape.cells;
  marked.resize(problem.shape.cell_count());
  for_cell_layers(problem.shape, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < n.y(); ++j)
        for (int i = 0; i < n.x(); ++i) {
          const std::size_t c = problem.shape.index(i, j, k);
          marked[c] = problem.liquid.values[c] < 0 && any_open_face(problem, {i, j, k});
        }
  });
}

/// Net outflow of a cell over h squared (m/s): liquid through the open part of the faces, solids
/// through the rest; minus what is asked for.
double excess_outflow(const Problem& problem, const MacGrid& velocity, const Eigen::Vector3i& at,
                      std::size_t cell) {
  double outflow = 0, open_sum = 0;
  for (int a = 0; a < 3; ++a) {
    for (int upper = 0; upper < 2; ++upper) {
      const std::size_t f = problem.face(a, at, upper);
      const double open = problem.solids.open[a].values[f];
      const double flow =
          open * velocity.face[a].values[f] + (1 - open) * problem.solids.velocity[a].values[f];
      outflow += upper ? flow : -flow;
      open_sum += open;
    }
  }
  if (problem.target) outflow -= problem.shape.cell * problem.target->values[cell] * open_sum / 6;
  return outflow;
}

/// Coefficients and right-hand side of row `c`. @return true when it touches air
bool assemble_row(const Problem& problem, const MacGrid& velocity, PressureSystem& system,
                  std::vector<double>& right, std::size_t c) {
  const std::size_t cell = system.cell[c];
  const Eigen::Vector3i at = problem.cell(cell);
  double diagonal = 0;
  bool touches_air = false;
  for (int a = 0; a < 3; ++a) {
    for (int upper = 0; upper < 2; ++upper) {
      const float open = problem.solids.open[a].values[problem.face(a, at, upper)];
      if (!(open > 0)) continue;
      const int next = at[a] + (upper ? 1 : -1);
      const bool beyond = next < 0 || next >= problem.shape.cells[a];
      const std::size_t neighbour = beyond  ? cell
                                    : upper ? cell + problem.stride(a)
                                            : cell - problem.stride(a);
      if (!beyond && system.number[neighbour] > 0) {
        diagonal += open;
        if (upper) system.link[a][c] = open;
      } else {
        diagonal += open / (beyond ? problem.border_theta(cell) : problem.theta(cell, neighbour));
        touches_air = true;
      }
    }
  }
  system.diagonal[c] = static_cast<float>(diagonal);
  right[c] = -excess_outflow(problem, velocity, at, cell);
  return touches_air;
}

/// Unknowns connected with `reached` ones, which become reached; appended to `stack` in order.
void flood(const PressureSystem& system, std::vector<char>& reached,
           std::vector<std::int32_t>& stack) {
  const auto visit = [&](std::size_t to, float link) {
    if (to == 0 || !(link > 0) || reached[to]) return;
    reached[to] = 1;
    stack.push_back(static_cast<std::int32_t>(to));
  };
  for (std::size_t s = 0; s < stack.size(); ++s) {
    const std::size_t c = stack[s];
    visit(c + 1, system.link[0][c]);
    visit(c - 1, system.link[0][c - 1]);
    for (std::size_t o = 0; o < 2; ++o) {
      const std::size_t down = system.lower[o][c];
      visit(static_cast<std::size_t>(system.upper[o][c]), system.link[o + 1][c]);
      visit(down, system.link[o + 1][down]);
    }
  }
}

/// Connected sets of unknowns that no air touches.
std::vector<std::vector<std::int32_t>> enclosed_regions(const PressureSystem& system,
                                                        std::vector<char>& touches_air) {
  std::vector<std::int32_t> stack;
  for (std::int32_t c = 1; c <= system.n; ++c)
    if (touches_air[c]) stack.push_back(c);
  flood(system, touches_air, stack);
  std::vector<std::vector<std::int32_t>> regions;
  for (std::int32_t c = 1; c <= system.n; ++c) {
    if (touches_air[c]) continue;
    touches_air[c] = 1;
    regions.push_back({c});
    flood(system, touches_air, regions.back());
  }
  return regions;
}

void remove_means(const std::vector<std::vector<std::int32_t>>& regions,
                  std::vector<double>& values) {
  for (const auto& region : regions) {
    double sum = 0;
    for (const std::int32_t c : region) sum += values[c];
    const double mean = sum / static_cast<double>(region.size());
    for (const std::int32_t c : region) values[c] -= mean;
  }
}

}  // namespace

struct PressureSolver::Workspace {
  PressureSystem system;
  std::unique_ptr<PressureApproximation> multigrid = make_multigrid_approximation();
  std::unique_ptr<PressureApproximation> cholesky = make_incomplete_cholesky_approximation();
  std::vector<std::uint8_t> marked;
  std::vector<char> touches_air;
  std::vector<std::vector<std::int32_t>> enclosed;
  std::vector<double> x, r, z, s, q;  ///< r starts as the right-hand side

  void assemble(const Problem& problem, const MacGrid& velocity);
  void solve(const PressureOptions& options, PressureReport& report);
  double step(double rho);
  void apply(const Problem& problem, MacGrid& velocity, std::array<std::vector<char>, 3>& valid);
  double remaining_divergence(const Problem& problem, const MacGrid& velocity);
};

void PressureSolver::Workspace::assemble(const Problem& problem, const MacGrid& velocity) {
  mark_liquid(problem, marked);
  system.number_cells(problem.shape.cells, marked);
  system.resize_coefficients();
  const std::size_t entries = static_cast<std::size_t>(system.n) + 2;
  for (auto* v : {&x, &r, &z, &s, &q}) v->assign(entries, 0);
  touches_air.assign(entries, 0);
  parallel_blocks(system.n, kPressureBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin + 1; c <= end; ++c)
      touches_air[c] = assemble_row(problem, velocity, system, r, c);
  });
  enclosed = enclosed_regions(system, touches_air);
  remove_means(enclosed, r);
}

/// One step of conjugate gradients along s. @return largest residual
double PressureSolver::Workspace::step(double rho) {
  system.multiply(s, q);
  const double curvature = ordered_dot(s, q);
  if (!(curvature > 0)) return largest_magnitude(r);
  const double alpha = rho / curvature;
  return ordered_reduce(
      r.size(),
      [&](std::size_t begin, std::size_t end) {
        double largest = 0;
        for (std::size_t c = begin; c < end; ++c) {
          x[c] += alpha * s[c];
          r[c] -= alpha * q[c];
          largest = std::max(largest, std::abs(r[c]));
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

void PressureSolver::Workspace::solve(const PressureOptions& options, PressureReport& report) {
  const double scale = largest_magnitude(r);
  if (!(scale > 0)) return;
  PressureApproximation& approximation =
      options.preconditioner == PressurePreconditioner::multigrid ? *multigrid : *cholesky;
  approximation.build(system);
  report.residual = 1;
  double rho = 0;
  while (report.residual > options.tolerance && report.iterations < options.max_iterations) {
    approximation.apply(r, z);
    const double next = ordered_dot(r, z);
    const double beta = report.iterations == 0 ? 0 : next / rho;
    rho = next;
    if (!(rho > 0)) break;
    parallel_blocks(s.size(), kPressureBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) s[c] = z[c] + beta * s[c];
    });
    report.residual = step(rho) / scale;
    ++report.iterations;
  }
  report.converged = report.residual <= options.tolerance;
  remove_means(enclosed, x);
}

void PressureSolver::Workspace::apply(const Problem& problem, MacGrid& velocity,
                                      std::array<std::vector<char>, 3>& valid) {
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i n = problem.shape.face_cells(a);
    ScalarGrid& u = velocity.face[a];
    valid[a].assign(u.values.size(), 0);
    const std::size_t stride = problem.stride(a);
    const auto update_face = [&](const Eigen::Vector3i& i) {
      const std::size_t f = u.index(i.x(), i.y(), i.z());
      const bool has_lower = i[a] > 0, has_upper = i[a] < problem.shape.cells[a];
      // The cell above the face, or one past the end of its row: only used when it exists.
      const std::size_t above = problem.shape.index(i.x(), i.y(), i.z());
      const std::size_t below = above - stride;
      const std::int32_t lower = has_lower ? system.number[below] : 0;
      const std::int32_t upper = has_upper ? system.number[above] : 0;
      if (lower == 0 && upper == 0) return;
      const bool on_wall = !has_lower || !has_upper;
      if (!(problem.solids.open[a].values[f] > 0)) {
        if (on_wall) u.values[f] = problem.solids.velocity[a].values[f];
        valid[a][f] = on_wall;
        return;
      }
      double step = x[upper] - x[lower];
      if (lower == 0) step /= has_lower ? problem.theta(above, below) : problem.border_theta(above);
      if (upper == 0) step /= has_upper ? problem.theta(below, above) : problem.border_theta(below);
      u.values[f] = static_cast<float>(u.values[f] - step);
      valid[a][f] = 1;
    };
    parallel_blocks(n.z(), kPressureLayers, [&](std::size_t begin, std::size_t end) {
      for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
        for (int j = 0; j < n.y(); ++j)
          for (int i = 0; i < n.x(); ++i) update_face({i, j, k});
    });
  }
}

double PressureSolver::Workspace::remaining_divergence(const Problem& problem,
                                                       const MacGrid& velocity) {
  parallel_blocks(system.n, kPressureBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin + 1; c <= end; ++c) {
      const std::size_t cell = system.cell[c];
      q[c] = excess_outflow(problem, velocity, problem.cell(cell), cell);
    }
  });
  remove_means(enclosed, q);
  return largest_magnitude(q) / problem.shape.cell;
}

PressureSolver::PressureSolver(const GridShape& shape)
    : shape_(shape), pressure_(shape.cells, 0), work_(std::make_shared<Workspace>()) {}

PressureReport PressureSolver::project(const SolidFractions& solids,
                                       const ScalarGrid& liquid_distance,
                                       const ScalarGrid* target_divergence, double dt,
                                       double density, const PressureOptions& options,
                                       MacGrid& velocity, std::array<std::vector<char>, 3>& valid) {
  if (!(dt > 0) || !(density > 0))
    throw Error("time step and density must be positive", "PressureSolver::project");
  const Problem problem{shape_, solids, liquid_distance, target_divergence, options.smallest_theta};
  Workspace& work = *work_;
  PressureReport report;
  work.assemble(problem, velocity);
  report.liquid_cells = work.system.n;
  report.enclosed_regions = static_cast<int>(work.enclosed.size());
  work.solve(options, report);
  work.apply(problem, velocity, valid);
  report.max_divergence = work.remaining_divergence(problem, velocity);
  const double unit = density * shape_.cell / dt;
  parallel_blocks(pressure_.values.size(), kPressureBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      pressure_.values[i] = static_cast<float>(unit * work.x[work.system.number[i]]);
  });
  return report;
}

void describe(OptionVisitor& v, PressureOptions& options) {
  static constexpr std::array<std::string_view, 2> kPreconditioners{"multigrid",
                                                                    "incomplete-cholesky"};
  describe_choice(
      v, "preconditioner", options.preconditioner, kPreconditioners,
      {.doc = "preconditioner of the conjugate gradients: a V-cycle of aggregates, or MIC(0)"});
  v.value("tolerance", options.tolerance,
          {.doc = "largest residual relative to the largest right-hand side",
           .min = 1e-12,
           .max = 0.1});
  v.value(
      "max_iterations", options.max_iterations,
      {.doc =
           "most iterations of the conjugate gradients; with 0 the velocity stays (a null control)",
       .min = 0,
       .max = 1e6});
  v.value("smallest_theta", options.smallest_theta,
          {.doc = "least fraction of liquid between the centres of a liquid cell and of air",
           .min = 1e-6,
           .max = 0.5});
}

}  // namespace geoprior::fluid
