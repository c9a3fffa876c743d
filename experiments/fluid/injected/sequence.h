#pragma once

#include <cstdint>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "core/options.h"

namespace geoprior::fluid {

/// An animated surface made of features whose truth is known, to measure extraction and tracking
/// against: a pool with bumps that travel in lanes, rings that expand where drops fall, drops that
/// cross each other in the air. No physics but the drops' parabolas.
struct InjectedOptions {
  int bumps = 2;
  int rings = 3;
  int drops = 2;
  int crossings = 1;
  int merges = 0;
  double dropout = 0;  ///< share of frames, but its first and last two, that miss a feature
  int longest_dropout = 1;
  double noise = 0;
  int resolution = 1;
  int frames = 36;
  double cell = 0.02;
  double frame_interval = 1.0 / 30;
  bool tank = false;
  bool velocity = false;
  std::uint64_t seed = 1;
};
void describe(OptionVisitor& v, InjectedOptions& options);

/// A feature in a frame in which it is there.
struct InjectedTruth {
  int id = 0;  ///< 1 …
  int frame = 0;
  bool isolated = false;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
  double radius = 0;  ///< of the drop; of the disc that holds the bump (2 sigma) or ring (m)
  double area = 0;    ///< of the drop, of the disc (m^2)
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero(), box_max = Eigen::Vector3d::Zero();
};
/// Feature `from` ends where `to` begins (a drop and its ring), or runs into it (`merge`).
struct InjectedCause {
  int from = 0, to = 0;
  bool merge = false;
};

/// Frames are made when they are asked for, each from the options alone.
class InjectedSequence final : public SurfaceSequence {
 public:
  /// @throws Error  for counts, sizes or shares out of range
  explicit InjectedSequence(const InjectedOptions& options);
  [[nodiscard]] int frame_count() const override { return options_.frames; }
  [[nodiscard]] double time(int frame) const override;
  [[nodiscard]] SurfaceFrame frame(int frame) const override;
  [[nodiscard]] std::string name() const override { return "injected features"; }

  /// Ordered by frame, then id.
  [[nodiscard]] const std::vector<InjectedTruth>& truth() const { return truth_; }
  [[nodiscard]] const std::vector<InjectedCause>& causes() const { return causes_; }
  /// Nodes of a layer of the lattice, about the vertices of a frame.
  [[nodiscard]] double layer_nodes() const { return size_.prod() / (cell() * cell()); }
  /// Spacing of the lattice (m).
  [[nodiscard]] double cell() const { return options_.cell / options_.resolution; }

  enum class Shape { bump, ring, drop };
  /// Alive from frame `begin` to before `end`, but for the frames that it misses.
  struct Item {
    int id = 0;
    Shape shape = Shape::bump;
    int begin = 0, end = 0;
    std::vector<int> missing;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();        ///< centre at frame `begin` (m)
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< there (m/s); drops fall from then on
    double radius = 0;                                   ///< of a drop; of a ring at `begin` (m)
    double growth = 0;                                   ///< of a ring's radius (m/s)
    double width = 0;                                    ///< sigma of a bump, of a ring's crest (m)
    double amplitude = 0;                                ///< m
    int grows_at = 0;  ///< frame from which `gain` is added to the amplitude (a merge)
    double gain = 0;   ///< m
    [[nodiscard]] bool alive(int frame) const;
  };

 private:
  [[nodiscard]] Eigen::Vector3d centre(const Item& item, int frame) const;
  [[nodiscard]] InjectedTruth truth_of(const Item& item, int frame) const;
  [[nodiscard]] double height(double x, double y, int frame) const;
  [[nodiscard]] TriMesh pool(int frame) const;

  InjectedOptions options_;
  Eigen::Vector2d size_{0, 0};  ///< of the pool, from the origin (m)
  double depth_ = 0;            ///< of the tank (m)
  std::vector<Item> items_;
  std::vector<InjectedTruth> truth_;
  std::vector<InjectedCause> causes_;
};

/// Items and causes of the options; sets the pool's size.
std::vector<InjectedSequence::Item> injected_layout(const InjectedOptions& options,
                                                    Eigen::Vector2d& size,
                                                    std::vector<InjectedCause>& causes);

}  // namespace geoprior::fluid
