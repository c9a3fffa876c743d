#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/options.h"
#include "core/surface_sequence.h"
#include "solvers/fluid/curvature.h"

namespace geoprior {

enum class ThresholdKind { automatic, given };

/// Parts of a frame that are not considered: walls and solids. Given as boxes, or inferred.
struct MaskOptions {
  bool infer_walls = true;  ///< planar, upright sides of the sequence's bounding box
  double band = 2.5;        ///< vertices within this many cells of a wall or solid are masked
};
void describe(OptionVisitor& v, MaskOptions& options);

struct SegmentationOptions {
  CurvatureOptions curvature;
  MaskOptions mask;
  double cell = 0;  ///< h, unit of lengths below (m); 0: mean edge of the first frame
  ThresholdKind thresholds = ThresholdKind::automatic;
  double high = 0.12;         ///< seeds: |H| h above this (given)
  double low = 0.04;          ///< grown through |H| h above this (given)
  double noise_factor = 6;    ///< automatic: low = median + this * MAD of the calm frames
  double seed_factor = 3;     ///< automatic: high = this * low
  double smallest_area = 20;  ///< regions below this many h^2 are dropped
  double close_radius = 2;    ///< dilation then erosion (h)
  double open_radius = 1;     ///< erosion then dilation (h)
  double largest_hole = 100;  ///< holes of a region up to this many h^2 are filled
  double largest_drop = 0.1;  ///< isolated: volume at most this share of the largest component's
};
void describe(OptionVisitor& v, SegmentationOptions& options);

enum class RegionKind { isolated, differential };

/// A feature's support in one frame: a node of the tracking graph.
struct Region {
  int frame = 0;
  int label = 0;  ///< within the frame, 1 …
  RegionKind kind = RegionKind::differential;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< of area; of volume when isolated (m)
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< mean of the vertices', or 0 (m/s)
  bool has_velocity = false;
  double area = 0;                                       ///< m^2
  double volume = 0;                                     ///< m^3, isolated only
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of area (m^2)
  double mean_curvature = 0;                             ///< 1/m
  double crest_share = 0;                                ///< share of the area with H > 0
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero(), box_max = Eigen::Vector3d::Zero();
};

/// A frame with every vertex labelled: 0 bed, 1 … region.
struct SegmentedFrame {
  Eigen::VectorXd curvature;  ///< H (1/m)
  std::vector<int> label;
  std::vector<char> masked;
  std::vector<Region> regions;
  std::vector<std::string> warnings;  ///< "inward oriented: turned over", "empty", …
};

struct Thresholds {
  double high = 0.12, low = 0.04;
};

/// Walls and thresholds that a whole sequence decides; made once, then every frame is on its own.
class Segmenter {
 public:
  /// Looks at up to 16 frames. @throws Error  when all frames are empty
  Segmenter(const SurfaceSequence& sequence, const SegmentationOptions& options);
  [[nodiscard]] SegmentedFrame segment(const SurfaceFrame& frame, int frame_index) const;
  [[nodiscard]] const Thresholds& thresholds() const { return thresholds_; }
  [[nodiscard]] double cell() const { return cell_; }

 private:
  SegmentationOptions options_;
  Thresholds thresholds_;
  double cell_ = 0;
  std::optional<Eigen::AlignedBox3d> walls_;
};

/// Geodesic (edge graph) dilation, erosion of a vertex set by a metric radius (m).
std::vector<char> dilate(const TriMesh& mesh, const std::vector<char>& set, double radius);
std::vector<char> erode(const TriMesh& mesh, const std::vector<char>& set, double radius);

}  // namespace geoprior
