#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace geoprior::grammar {

/// What an element of a set is to its spacing.
enum class SpacedKind : char {
  element,    ///< full size where there is room
  candidate,  ///< not there, unless there is more room than a full element needs
  fixed       ///< of a size that is given; comes before all others
};

/// What is known of an element before sizes are found.
enum class SpacedState : char {
  kept,   ///< it keeps its size, unless an element before it moved or got another size
  asked,  ///< its size is to be found
  moved,  ///< the same, and it is at another place than before
  known   ///< its size is given, whatever is near
};

/// Elements in their order of priority. Arrays of one length.
struct SpacedSet {
  std::vector<Eigen::Vector3d> x;  ///< m
  std::vector<double> radius;      ///< half the spacing at full size (m), positive
  std::vector<double> size;        ///< 0 (not there) … 1, as it was
  std::vector<SpacedKind> kind;
  std::vector<SpacedState> state;

  [[nodiscard]] int count() const { return static_cast<int>(x.size()); }
  void resize(int n);
  void add(const Eigen::Vector3d& place, double its_radius, double its_size, SpacedKind its_kind,
           SpacedState its_state);
};

/// Room over that of a full element, in radii, with which a candidate is at its full size.
inline constexpr double kCandidateBand = 0.3;

/// Distance beyond which elements of this radius at most do not matter to each other (m).
double spacing_reach(double largest_radius);

/// Sizes with which elements keep apart, |x_i - x_j| >= s_i R_i + s_j R_j, in order of priority:
///
///   m_i = min over j before i of (|x_i - x_j| - s_j R_j) / R_i
///   s_i = clamp(m_i, 0, 1)             an element
///   s_i = clamp((m_i - 1) / b, 0, 1)   a candidate, b = kCandidateBand
///
/// m_i is taken times 1 - 1e-12, so that the distance holds beyond rounding. Sizes are continuous
/// in the places: nothing pops, an element shrinks to a point before it is gone. Elements that are
/// gone, of size 0, still keep later ones from covering their places; else these would jump.
///
/// Where elements are at twice their radius or more and each candidate is nearer than that to one
/// of them, all elements have size 1 and no candidate is there. Two fixed ones are not kept apart.
///
/// `spaced_sizes_plainly` is the formula, in the order of priority, n^2 distances.
/// `spaced_sizes` gives the same numbers, bit for bit, at any thread count: elements are sorted
/// into the cells of a grid, and one whose size is asked for first asks those near and before it.
std::vector<double> spaced_sizes_plainly(const SpacedSet& set);
std::vector<double> spaced_sizes(const SpacedSet& set);

/// A circle in plan that is to meet no other.
struct SpacedCircle {
  Eigen::Vector2d centre{0, 0};  ///< m
  double radius = 0;             ///< m
  bool is_fixed = false;
};
bool circles_meet(const SpacedCircle& a, const SpacedCircle& b);

/// Moves circles apart that meet: pair after pair is projected onto its distance, a fixed one not
/// moved, again and again until none meet, or for so long. The rest stay where they are, bit for
/// bit. Continuous in the centres but for 1e-6 of a radius.
/// @return  whether none meet, but for fixed ones
bool push_circles_apart(std::vector<SpacedCircle>& circles);

/// A stone of a path.
struct PathStone {
  double along = 0;            ///< where in the path, 0 … 1
  Eigen::Vector3d x{0, 0, 0};  ///< m
  double size = 1;             ///< 0: not there
  bool is_candidate = false;   ///< not there at rest
  bool is_fixed = false;       ///< of a size that is given
};

/// Least and largest distance of consecutive stones over the pitch.
inline constexpr double kLeastStep = 0.6, kLargestStep = 1.4;

/// Where a point near a path is on the ground; absent beyond its rim.
using PathGround = std::function<std::optional<Eigen::Vector3d>(const Eigen::Vector3d&)>;

/// Which stones of a path are there, and how large: the path is halved again and again where its
/// ends are more than a step apart.
///
/// Between two stones i and j that are g pitches apart the middle one has the size
/// min(s_i, s_j) clamp((g - 1.2) / 0.2, 0, 1). It stands at its own place or, where that is nearer
/// than 0.6 pitches to i or j, further along the path, just so far from there: by the triangle
/// inequality it is not too near to the other, as 1.2 = 2 * 0.6. So distances are at least 0.6
/// pitches, and at most 1.4 as long as there are candidates. Ends and fixed ones are always there.
///
/// @param stones  in order along the path; gets places, sizes and `along`
/// @param pitch   distance of stones at rest (m)
void space_path(std::vector<PathStone>& stones, double pitch, const PathGround& ground);

/// A step that is out of the range above, beyond rounding (m); absent where all are in it.
std::optional<double> broken_step(std::span<const PathStone> stones, double pitch);

/// Takes along what is beside a stone that was moved, the less the further along the path it is;
/// as far as the next fixed one.
/// @param moved  number of the stone, which is where it is to be
/// @param shift  by which it was moved (m)
void bend_path(std::vector<PathStone>& stones, int moved, const Eigen::Vector3d& shift,
               double pitch, const PathGround& ground);

/// Disks, or balls, that are placed one after the other where they are at a distance from all
/// before.
class DiskSampler {
 public:
  /// @param box       that holds all places
  /// @param distance  m, positive
  /// @param places    about as many as will be tried
  DiskSampler(const Eigen::AlignedBox3d& box, double distance, double places);
  ~DiskSampler();
  /// @return  whether it is placed
  bool place(const Eigen::Vector3d& x);
  [[nodiscard]] const std::vector<Eigen::Vector3d>& places() const { return places_; }

 private:
  struct Cells;
  double squared_;
  std::unique_ptr<Cells> cells_;
  std::vector<Eigen::Vector3d> places_;
};

/// An arrangement at rest: elements at `spacing`, and among them candidates.
struct DiskSampling {
  std::vector<Eigen::Vector3d> elements, candidates;  ///< m
  std::vector<int> element_number, candidate_number;  ///< of the point that was tried
};

/// A Poisson-disk sampling, maximal in points that are tried in order: each of the others is nearer
/// than the spacing to an element. Of these the candidates are at 0.7 spacings from each other and
/// from elements, so dense that stretched places are filled; no two of them are so near that one
/// that is not there would hinder the other.
/// @param point  number i, at random in `box`; asked for twice
DiskSampling sample_disks(int count, const std::function<Eigen::Vector3d(int)>& point,
                          const Eigen::AlignedBox3d& box, double spacing);

}  // namespace geoprior::grammar
