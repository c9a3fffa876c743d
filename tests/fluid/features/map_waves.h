#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "core/random.h"
#include "solvers/fluid/lift/lift.h"
#include "solvers/fluid/paste/paste.h"

namespace geoprior::fluid::waves {

inline const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// Closed box: a top of n x n cells over [0, size]^2 at z = 0, a floor at z = -depth, sides between
/// them. Top vertices come first, x fastest, interior ones moved in the plane by up to `jitter`
/// cells: no grid of texels meets them.
inline TriMesh tank(int n, double size, double depth, double jitter) {
  const int row = n + 1, top = row * row;
  TriMesh mesh;
  mesh.V.resize(2 * top, 3);
  RandomStream random(1, "tank");
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && j > 0 && i < n && j < n;
      const double dx = inner ? jitter * (2 * random.uniform() - 1) : 0;
      const double dy = inner ? jitter * (2 * random.uniform() - 1) : 0;
      mesh.V.row(j * row + i) << (i + dx) * size / n, (j + dy) * size / n, 0;
      mesh.V.row(top + j * row + i) << i * size / n, j * size / n, -depth;
    }
  }
  std::vector<Eigen::RowVector3i> triangles;
  const auto quad = [&](int a, int b, int c, int d) {
    triangles.emplace_back(a, b, c);
    triangles.emplace_back(a, c, d);
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * row + i;
      quad(a, a + 1, a + row + 1, a + row);
      quad(top + a, top + a + row, top + a + row + 1, top + a + 1);
    }
  }
  for (int i = 0; i < n; ++i) {
    quad(i + 1, i, top + i, top + i + 1);
    const int back = n * row + i;
    quad(back, back + 1, top + back + 1, top + back);
    const int left = i * row, right = i * row + n;
    quad(left, left + row, top + left + row, top + left);
    quad(right + row, right, top + right, top + right + row);
  }
  mesh.F.resize(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    mesh.F.row(t) = triangles[t];
  }
  return mesh;
}

/// A displacement of the rest surface (x, y) at a time, and whether (x, y) belongs to the feature.
struct Wave {
  std::function<Eigen::Vector3d(double x, double y, double t)> displacement;
  std::function<bool(double x, double y, double t)> inside;
};

/// Gaussian hill of height A and width sigma (m) whose centre starts at `centre` and moves with
/// `velocity`; the crest is thrown forward by `throw_forward` (m): it overhangs beyond 1.17 sigma.
struct Hill {
  double height = 0.1, sigma = 0.15, throw_forward = 0;
  Eigen::Vector2d centre{1, 1}, velocity{0, 0};
  double support = 3;  ///< of the label (sigma)
};

inline Wave hill(const Hill& h) {
  const auto radius = [h](double x, double y, double t) {
    return (Eigen::Vector2d(x, y) - h.centre - t * h.velocity).norm();
  };
  return {[=](double x, double y, double t) {
            const double r = radius(x, y, t) / h.sigma, f = std::exp(-0.5 * r * r);
            return Eigen::Vector3d(h.throw_forward * f * f, 0, h.height * f);
          },
          [=](double x, double y, double t) { return radius(x, y, t) < h.support * h.sigma; }};
}

/// A sequence on a rest mesh, with the labels of its one feature by hand.
struct Labelled {
  std::shared_ptr<StoredSequence> sequence;
  std::vector<FrameLabels> labels;
  Extraction extraction;

  [[nodiscard]] Labeller labeller() const {
    return [this](const SurfaceFrame&, int frame) { return labels[frame]; };
  }
  [[nodiscard]] Feature lift(const MapOptions& options = {}) const {
    RunContext context;
    return lift_tracks(*sequence, extraction, labeller(), options, {1}, context).front();
  }
  [[nodiscard]] SurfaceFrame bed(int frame, const MapOptions& options = {}) const {
    return without_regions(sequence->frame(frame), labels[frame], {extraction.regions[frame]},
                           options.border * extraction.cell);
  }
};

inline Labelled labelled(const TriMesh& rest, int movable, const Wave& wave, int frames, double dt,
                         double cell, const Eigen::Affine3d& placed = Eigen::Affine3d::Identity()) {
  Labelled result;
  std::vector<SurfaceFrame> stored;
  Track track;
  track.id = 1;
  for (int f = 0; f < frames; ++f) {
    SurfaceFrame frame;
    frame.time = f * dt;
    frame.mesh = rest;
    FrameLabels labels;
    labels.label.assign(rest.vertex_count(), 0);
    labels.masked.assign(labels.label.size(), 0);
    for (int v = 0; v < movable; ++v) {
      const double x = rest.V(v, 0), y = rest.V(v, 1);
      frame.mesh.V.row(v) += wave.displacement(x, y, frame.time).transpose();
      labels.label[v] = wave.inside(x, y, frame.time) ? 1 : 0;
    }
    for (Eigen::Index v = 0; v < frame.mesh.V.rows(); ++v) {
      frame.mesh.V.row(v) = (placed * frame.mesh.V.row(v).transpose()).transpose();
    }
    Region region;
    region.frame = f;
    region.label = 1;
    result.extraction.regions.push_back(region);
    result.extraction.times.push_back(frame.time);
    track.regions.push_back(f);
    result.labels.push_back(std::move(labels));
    stored.push_back(std::move(frame));
  }
  result.extraction.cell = cell;
  result.extraction.tracking.tracks.push_back(track);
  result.sequence = std::make_shared<StoredSequence>(std::move(stored), "waves");
  return result;
}

/// Root mean square distance of the first rows of two vertex lists, over those with a label.
inline double rms_over_region(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b,
                              const std::vector<int>& label) {
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] == 0) continue;
    const Eigen::Index i = v;
    sum += (a.row(i) - b.row(i)).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / std::max(1, count));
}

inline double largest_distance(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b) {
  const Eigen::Index n = std::min(a.rows(), b.rows());
  return (a.topRows(n) - b.topRows(n)).rowwise().norm().maxCoeff();
}

inline Insertion identity(const Feature& feature) {
  Insertion insertion{&feature, {}};
  insertion.edit.name = "identity";
  return insertion;
}

}  // namespace geoprior::fluid::waves
