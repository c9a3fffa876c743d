// What a step of a sheet spends its time on: elements, fill, factorisation, solve, the whole step,
// and the analysis of a new connectivity. The sheet is bent, so that no term is zero.
//
//   geoprior_kernels --benchmark_filter=paper

#include <benchmark/benchmark.h>

#include <optional>
#include <vector>

#include "baselines/paper/dense.h"
#include "models/paper/cholesky/cholmod.h"
#include "models/paper/cholesky/eigen.h"
#include "models/paper/cholesky/sparse_cholesky.h"
#include "models/paper/cholesky/supernodal.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/shell/step/matrix.h"
#include "models/paper/shell/stepper.h"
#include "models/paper/shell/system.h"

namespace geoprior::paper {
namespace {

/// A square metre whose left and right edges approach each other.
Sheet bent_sheet() {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(1, 1);
  for (const double side : {-1.0, 1.0}) {
    Handle handle;
    handle.name = side < 0 ? "left" : "right";
    handle.points = {{side / 2, -0.5}, {side / 2, 0.5}};
    Keyframe end;
    end.time = 5;
    end.shift = {-side * 0.45, 0, 0};
    handle.motion = Trajectory{{Keyframe{}, end}};
    sheet.handles.push_back(handle);
  }
  return sheet;
}

constexpr double kStep = 0.005;

struct Bent {
  explicit Bent(int triangles, LinearSolver solver = LinearSolver::supernodal) {
    sheet = bent_sheet();
    state = resting_state(sheet,
                          uniform_mesh(sheet.pattern, triangles, UniformLayout::structured,
                                       handle_points(sheet, 0.05), 1),
                          1);
    StepperOptions options;
    options.solver = solver;
    stepper.emplace(sheet, options, 1);
    stepper->set_mesh(state);
    for (int k = 0; k < 40; ++k) stepper->step(state, kStep, context);
  }
  RunContext context;
  Sheet sheet;
  ShellState state;
  std::optional<ShellStepper> stepper;
};

/// The parts of a step on their own.
struct Parts {
  explicit Parts(const Bent& bent, bool eigen)
      : elements(bent.state.mesh, bent.sheet.material, BendingLaw()) {
    std::vector<int> offset(1, 0), members;
    for (int e = 0; e < elements.size(); ++e) {
      const auto nodes = elements.nodes(e);
      members.insert(members.end(), nodes.begin(), nodes.end());
      offset.push_back(static_cast<int>(members.size()));
    }
    const NodeGraph graph = couple_groups(bent.state.mesh.vertex_count(), offset, members);
    const std::vector<int> position =
        elimination_order(graph, elements.size() < kDissectionFrom ? Ordering::minimum_degree
                                                                   : Ordering::nested_dissection);
    using Triangle = BlockMatrix::Triangle;
    matrix = BlockMatrix(graph, position, eigen ? Triangle::upper : Triangle::lower);
    system.emplace(elements, position, matrix);
    fill(bent);
  }
  void fill(const Bent& bent) {
    matrix.set_zero();
    system->hessian(elements, bent.state, bent.state.x, kStep * kStep, sums, matrix);
    for (int i = 0; i < matrix.nodes(); ++i) matrix.add_to_diagonal(i, 1e-5);
  }
  ShellElements elements;
  BlockMatrix matrix;
  std::optional<ShellSystem> system;
  ShellSystem::Sums sums;
};

void paper_elements(benchmark::State& state) {
  const Bent bent(static_cast<int>(state.range(0)));
  const ShellElements elements(bent.state.mesh, bent.sheet.material, BendingLaw());
  ShellElements::Local local;
  for (auto _ : state) {
    for (int e = 0; e < elements.size(); ++e) {
      elements.evaluate(e, bent.state, bent.state.x, ShellElements::Order::hessian, local);
      benchmark::DoNotOptimize(local.hessian.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * elements.size());
}

void paper_fill(benchmark::State& state) {
  const Bent bent(static_cast<int>(state.range(0)));
  Parts parts(bent, false);
  for (auto _ : state) parts.fill(bent);
}

template <std::unique_ptr<SparseCholesky> (*make)(const BlockMatrix&)>
void paper_factorise(benchmark::State& state) {
  const Bent bent(static_cast<int>(state.range(0)));
  const Parts parts(bent, make == make_eigen_cholesky);
  const auto cholesky = make(parts.matrix);
  for (auto _ : state) benchmark::DoNotOptimize(cholesky->factorise(parts.matrix));
  state.counters["nonzeros"] = static_cast<double>(cholesky->nonzeros());
}

template <std::unique_ptr<SparseCholesky> (*make)(const BlockMatrix&)>
void paper_solve(benchmark::State& state) {
  const Bent bent(static_cast<int>(state.range(0)));
  const Parts parts(bent, make == make_eigen_cholesky);
  const auto cholesky = make(parts.matrix);
  if (!cholesky->factorise(parts.matrix)) state.SkipWithError("not positive definite");
  Eigen::VectorXd b = parts.sums.gradient;
  for (auto _ : state) {
    cholesky->solve(b);
    b = parts.sums.gradient;
  }
}

void paper_step(benchmark::State& state) {
  Bent bent(static_cast<int>(state.range(0)), static_cast<LinearSolver>(state.range(1)));
  for (auto _ : state) bent.stepper->step(bent.state, kStep, bent.context);
}

void paper_set_mesh(benchmark::State& state) {
  Bent bent(static_cast<int>(state.range(0)));
  for (auto _ : state) bent.stepper->set_mesh(bent.state);
}

void small_and_large(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(200)->Arg(500)->Arg(4096)->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime();
}
void every_solver(benchmark::internal::Benchmark* benchmark) {
  for (const int triangles : {200, 500, 4096}) {
    for (const LinearSolver solver :
         {LinearSolver::eigen, LinearSolver::cholmod, LinearSolver::supernodal}) {
      benchmark->Args({triangles, static_cast<int>(solver)});
    }
  }
  benchmark->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime();
}

BENCHMARK(paper_elements)->Apply(small_and_large);
BENCHMARK(paper_fill)->Apply(small_and_large);
BENCHMARK_TEMPLATE(paper_factorise, make_eigen_cholesky)->Apply(small_and_large);
BENCHMARK_TEMPLATE(paper_factorise, make_cholmod_cholesky)->Apply(small_and_large);
BENCHMARK_TEMPLATE(paper_factorise, make_supernodal_cholesky)->Apply(small_and_large);
BENCHMARK_TEMPLATE(paper_solve, make_eigen_cholesky)->Apply(small_and_large);
BENCHMARK_TEMPLATE(paper_solve, make_cholmod_cholesky)->Apply(small_and_large);
BENCHMARK_TEMPLATE(paper_solve, make_supernodal_cholesky)->Apply(small_and_large);
BENCHMARK(paper_step)->Apply(every_solver);
BENCHMARK(paper_set_mesh)->Arg(300)->Apply(small_and_large);

}  // namespace
}  // namespace geoprior::paper
