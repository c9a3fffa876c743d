#include "models/grammar/objects/tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/random.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

constexpr double kTreeGoldenAngle = 2.399963229728653;  // rad
constexpr int kTrunkSegments = 5;
constexpr int kTreeSides = 8;
constexpr double kTwigTaper = 0.45;
constexpr double kChainShare = 0.72;  // of the places for a chain that have one

/// A branch before radii are known.
struct GrownBranch {
  int parent = -1;
  double attach = 0;
  int level = 0;
  Vector3d base, tip;
};

/// A place where a chain may leave a branch.
struct ChainSite {
  int branch = -1;
  double attach = 0;
  Vector3d direction;
};

/// Grows the axes of a tree, level by level, where there is room.
class TreeGrowth {
 public:
  TreeGrowth(const TreeOptions& options, std::uint64_t seed)
      : o_(options), random_(seed, "tree"), grid_(0.05 * options.height, options.branches) {}

  std::vector<GrownBranch> grow() {
    std::vector<ChainSite> sites = trunk();
    for (int level = 1; level <= o_.levels; ++level) {
      if (level == o_.levels) shuffle(sites);
      std::vector<ChainSite> next;
      for (const ChainSite& site : sites) grow_chain(site, level, next);
      sites = std::move(next);
    }
    return std::move(branches_);
  }
  /// Upper bound of the radii of a level (m).
  [[nodiscard]] double radius(int level) const {
    return o_.trunk * o_.height * (level == 0 ? 1 : 0.42 * std::pow(0.55, level - 1));
  }

 private:
  [[nodiscard]] bool full() const { return static_cast<int>(branches_.size()) >= o_.branches; }
  [[nodiscard]] double mean(int level) const {
    return o_.height * (level == 0 ? 0.12 : 0.085 * std::pow(0.8, level - 1));
  }
  [[nodiscard]] static int chain_length(int level) { return level == 1 ? 5 : level == 2 ? 3 : 2; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  Vector3d any_direction() {
    const double z = between(-1, 1), angle = between(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  void shuffle(std::vector<ChainSite>& sites) {
    for (std::size_t i = sites.size(); i > 1; --i)
      std::swap(sites[i - 1], sites[random_.below(static_cast<std::uint32_t>(i))]);
  }

  /// Whether a point is in the crown, an ellipsoid that is flatter below.
  [[nodiscard]] bool in_crown(const Vector3d& x) const {
    const double across = 0.5 * o_.spread * o_.height, middle = 0.6 * o_.height;
    const double up = x.z() > middle ? 0.4 * o_.height : 0.38 * o_.height;
    const double z = (x.z() - middle) / up;
    return (x.x() * x.x() + x.y() * x.y()) / (across * across) + z * z <= 1;
  }

  /// Appends a branch if it crosses nothing.
  bool add(int parent, double attach, int level, const Vector3d& direction, double length) {
    const Vector3d base = parent < 0
                              ? Vector3d(Vector3d::Zero())
                              : Vector3d(branches_[parent].base +
                                         attach * (branches_[parent].tip - branches_[parent].base));
    const Capsule capsule{base, base + length * direction, radius(level)};
    const auto meets = [&](int other) {
      return other == parent ||
             (branches_[other].parent == parent && branches_[other].attach == attach);
    };
    if (grid_.deepest(capsule, 0.5 * radius(level), meets)) return false;
    grid_.place(static_cast<int>(branches_.size()), capsule);
    branches_.push_back({parent, attach, level, capsule.a, capsule.b});
    return true;
  }

  std::vector<ChainSite> trunk() {
    std::vector<ChainSite> sites;
    Vector3d direction = Vector3d::UnitZ();
    double azimuth = between(0, 2 * std::numbers::pi);
    for (int i = 0; i < kTrunkSegments; ++i) {
      if (i > 0) direction = (direction + o_.wobble * any_direction() + 0.1 * Vector3d::UnitZ());
      direction.normalize();
      add(i - 1, 1, 0, direction, mean(0) * between(0.9, 1.1));
      if (i == 0) continue;
      for (const double attach : {0.3, 0.65}) {
        const double height = (i + attach) / kTrunkSegments;
        const double incline = (75 - 35 * height) * std::numbers::pi / 180;
        sites.push_back({i, attach, leaving(direction, incline, azimuth)});
        azimuth += kTreeGoldenAngle;
      }
    }
    sites.push_back({kTrunkSegments - 1, 1, direction});
    return sites;
  }

  static Vector3d leaving(const Vector3d& axis, double incline, double azimuth) {
    const Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
    return std::cos(incline) * axis +
           std::sin(incline) * (std::cos(azimuth) * x + std::sin(azimuth) * y);
  }

  /// A chain from a site until it leaves the crown, and the sites of the next level on it.
  void grow_chain(const ChainSite& site, int level, std::vector<ChainSite>& next) {
    int parent = site.branch;
    double attach = site.attach;
    Vector3d direction = site.direction;
    double azimuth = between(0, 2 * std::numbers::pi);
    for (int i = 0; i < chain_length(level) && !full(); ++i) {
      const double length = mean(level) * between(0.85, 1.15);
      bool grown = false;
      for (int trial = 0; trial < 6 && !grown; ++trial) {
        Vector3d d = direction + (o_.wobble * (1 + 0.5 * trial)) * any_direction();
        d.z() += level == 1 ? 0.12 : 0.05;
        d.normalize();
        const Vector3d from =
            branches_[parent].base + attach * (branches_[parent].tip - branches_[parent].base);
        if (!in_crown(from + length * d)) continue;
        grown = add(parent, attach, level, d, length);
        if (grown) direction = d;
      }
      if (!grown) break;
      parent = static_cast<int>(branches_.size()) - 1;
      attach = 1;
      for (const double place : {0.4, 0.75}) {
        const double incline = between(35, 65) * std::numbers::pi / 180;
        azimuth += kTreeGoldenAngle;
        // Bare near its start, and thin enough that twigs are left for all.
        if ((i == 0 && place < 0.5 && level < 3) || random_.uniform() > kChainShare) continue;
        next.push_back({parent, place, leaving(direction, incline, azimuth)});
      }
    }
    if (attach == 1 && parent != site.branch) next.push_back({parent, 1, direction});
  }

  const TreeOptions& o_;
  RandomStream random_;
  CapsuleGrid grid_;
  std::vector<GrownBranch> branches_;
};

/// Radii by the pipe model, from the trunk's radius down to the twigs'.
std::vector<double> pipe_radii(const std::vector<GrownBranch>& branches, const TreeGrowth& growth) {
  std::vector<double> area(branches.size(), 0);
  for (std::size_t i = branches.size(); i-- > 0;) {
    if (area[i] == 0) area[i] = 1;
    if (branches[i].parent >= 0) area[branches[i].parent] += area[i];
  }
  std::vector<double> out(branches.size());
  for (std::size_t i = 0; i < branches.size(); ++i)
    out[i] =
        std::min(growth.radius(0) * std::sqrt(area[i] / area[0]), growth.radius(branches[i].level));
  return out;
}

std::vector<double> level_means(const std::vector<GrownBranch>& branches) {
  std::vector<double> sum, count;
  for (const GrownBranch& b : branches) {
    sum.resize(std::max<std::size_t>(sum.size(), b.level + 1), 0);
    count.resize(sum.size(), 0);
    sum[b.level] += (b.tip - b.base).norm();
    count[b.level] += 1;
  }
  for (std::size_t level = 0; level < sum.size(); ++level) sum[level] /= count[level];
  return sum;
}

void require_tree_options(const TreeOptions& o) {
  const auto require = [](bool holds, const char* name, const char* allowed) {
    if (!holds)
      throw Error(std::string("'") + name + "' is out of its range", "make_tree", allowed);
  };
  require(o.height > 0 && o.height <= 100, "height", "0 to 100 m");
  require(o.levels >= 1 && o.levels <= 5, "levels", "1 to 5");
  require(o.branches >= 20 && o.branches <= 20000, "branches", "20 to 20000");
  require(o.spread >= 0.2 && o.spread <= 3, "spread", "0.2 to 3");
  require(o.trunk >= 0.002 && o.trunk <= 0.03, "trunk", "0.002 to 0.03");
  require(o.wobble >= 0 && o.wobble <= 0.5, "wobble", "0 to 0.5 rad");
}

/// A tapered prism of eight sides from the base to the tip, with a flat dome at either end.
TriMesh branch_mesh(std::span<const double> p) {
  const double length = p[BranchParameter::kLength], radius = p[BranchParameter::kRadius];
  const double tip = radius * p[BranchParameter::kTaper];
  struct Ring {
    double z, radius;
  };
  const Ring rings[] = {
      {-0.35 * radius, 0.8 * radius}, {0, radius}, {length, tip}, {length + 0.35 * tip, 0.8 * tip}};
  constexpr int kRings = 4;
  TriMesh m;
  m.V.resize(kRings * kTreeSides + 2, 3);
  m.F.resize(2 * kRings * kTreeSides, 3);
  const int low = kRings * kTreeSides, high = low + 1;
  m.V.row(low) << 0, 0, -0.5 * radius;
  m.V.row(high) << 0, 0, length + 0.5 * tip;
  int f = 0;
  for (int side = 0; side < kTreeSides; ++side) {
    const double angle = 2 * std::numbers::pi * side / kTreeSides;
    const int after = (side + 1) % kTreeSides;
    m.F.row(f++) << low, after, side;
    for (int r = 0; r < kRings; ++r) {
      const int here = r * kTreeSides;
      m.V.row(here + side) << rings[r].radius * std::cos(angle), rings[r].radius * std::sin(angle),
          rings[r].z;
      if (r + 1 == kRings) {
        m.F.row(f++) << here + side, here + after, high;
        continue;
      }
      m.F.row(f++) << here + side, here + after, here + kTreeSides + after;
      m.F.row(f++) << here + side, here + kTreeSides + after, here + kTreeSides + side;
    }
  }
  return m;
}

}  // namespace

void describe(OptionVisitor& v, TreeOptions& o) {
  v.value("height", o.height,
          {.doc = "height of the crown's top", .unit = "m", .min = 1e-3, .max = 100});
  v.value("levels", o.levels,
          {.doc = "levels of branches above the trunk: limbs, boughs, twigs", .min = 1, .max = 5});
  v.value("branches", o.branches,
          {.doc = "largest number of branches; the last level is thinned to meet it",
           .min = 20,
           .max = 20000});
  v.value("spread", o.spread,
          {.doc = "width of the crown over the height of the tree", .min = 0.2, .max = 3});
  v.value("trunk", o.trunk,
          {.doc = "radius of the trunk at the ground over the height of the tree",
           .min = 0.002,
           .max = 0.03});
  v.value("wobble", o.wobble,
          {.doc = "turn of a chain of branches from one to the next", .unit = "rad", .max = 0.5});
}

ElementType tree_type() {
  ElementType out;
  out.name = "tree";
  out.keys = [](std::span<const double>, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
  };
  return out;
}

ElementType branch_type() {
  ElementType out;
  out.name = "branch";
  out.parameters = {{"length", "m", 0, 1e3}, {"radius", "m", 0, 1e2}, {"attach", "1", 0, 1},
                    {"level", "1", 0, 100},  {"mean", "m", 0, 1e3},   {"taper", "1", 0, 1}};
  out.keys = [](std::span<const double> p, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
    keys.emplace_back(0, 0, p[BranchParameter::kLength]);
  };
  out.mesh = branch_mesh;
  return out;
}

Hierarchy make_tree(const TreeOptions& options, std::uint64_t seed) {
  require_tree_options(options);
  TreeGrowth growth(options, seed);
  const std::vector<GrownBranch> branches = growth.grow();
  const std::vector<double> radius = pipe_radii(branches, growth), mean = level_means(branches);
  std::vector<double> tip(branches.size(), 0);
  for (std::size_t i = 0; i < branches.size(); ++i)
    if (branches[i].parent >= 0 && branches[i].attach == 1) tip[branches[i].parent] = radius[i];
  Hierarchy out({tree_type(), branch_type()});
  out.reserve(branches.size() + 1, 6 * branches.size());
  out.add(0, -1, {});
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const GrownBranch& b = branches[i];
    const Vector3d along = b.tip - b.base;
    const double values[] = {along.norm(),  radius[i],
                             b.attach,      static_cast<double>(b.level),
                             mean[b.level], tip[i] > 0 ? tip[i] / radius[i] : kTwigTaper};
    const Eigen::Quaterniond turn = turned_along(Eigen::Quaterniond::Identity(), along);
    out.add(1, b.parent + 1, {attach_point(out, b.parent + 1, b.attach), turn}, values);
  }
  if (const int crossing = crossing_branch(out); crossing >= 0)
    throw Error("branches cross at rest", "element '" + out.label(crossing) + "'");
  return out;
}

Vector3d branch_axis(const Hierarchy& hierarchy, int branch) {
  return hierarchy.turn(branch) * Vector3d::UnitZ();
}

Eigen::Quaterniond turned_along(const Eigen::Quaterniond& turn, const Vector3d& direction) {
  const Vector3d axis = turn * Vector3d::UnitZ();
  return (Eigen::Quaterniond::FromTwoVectors(axis, direction) * turn).normalized();
}

Vector3d attach_point(const Hierarchy& hierarchy, int element, double attach) {
  if (hierarchy.parameters(element).empty()) return hierarchy.position(element);
  const double along = attach * hierarchy.parameter(element, BranchParameter::kLength);
  return hierarchy.position(element) + along * branch_axis(hierarchy, element);
}

Capsule branch_capsule(const Hierarchy& hierarchy, int branch) {
  return {hierarchy.position(branch), attach_point(hierarchy, branch, 1),
          hierarchy.parameter(branch, BranchParameter::kRadius)};
}

bool branches_meet(const Hierarchy& hierarchy, int first, int second) {
  if (hierarchy.parent(first) == second || hierarchy.parent(second) == first) return true;
  constexpr int kAttach = BranchParameter::kAttach;
  return hierarchy.parent(first) == hierarchy.parent(second) &&
         std::abs(hierarchy.parameter(first, kAttach) - hierarchy.parameter(second, kAttach)) <=
             1e-9;
}

int crossing_branch(const Hierarchy& hierarchy) {
  const int type = hierarchy.find_type("branch");
  std::vector<int> branches;
  double length = 0;
  for (int e = 0; e < hierarchy.size(); ++e) {
    if (hierarchy.type_number(e) != type || !hierarchy.present(e)) continue;
    branches.push_back(e);
    length += hierarchy.parameter(e, BranchParameter::kLength);
  }
  if (branches.empty()) return -1;
  const int count = static_cast<int>(branches.size());
  CapsuleGrid grid(length / count, count);
  for (const int e : branches) grid.place(e, branch_capsule(hierarchy, e));
  for (const int e : branches) {
    const auto meets = [&](int other) { return other == e || branches_meet(hierarchy, e, other); };
    if (grid.deepest(branch_capsule(hierarchy, e), 0, meets)) return e;
  }
  return -1;
}

}  // namespace geoprior::grammar
