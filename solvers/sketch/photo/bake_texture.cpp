#include "solvers/sketch/photo/bake_texture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/connectivity.h"
#include "core/disjoint_sets.h"
#include "core/error.h"
#include "solvers/sketch/photo/continued_patches.h"

namespace geoprior::sketch {
namespace {

constexpr double kInch = 0.0254;
constexpr int kMostSide = 30000;
constexpr double kMixed = 1;  ///< width of the mixed pixels along an edge (pixels)

/// Colour at pixel coordinates, bilinear; beyond the border that of the border.
Eigen::Vector3d photo_colour(const PixelImage& photo, const Eigen::Vector2d& at) {
  const double x = std::clamp(at.x(), 0.0, photo.width - 1.0);
  const double y = std::clamp(at.y(), 0.0, photo.height - 1.0);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, photo.width - 1),
            bottom = std::min(top + 1, photo.height - 1);
  const double s = x - left, t = y - top;
  const auto at_pixel = [&](int column, int row) {
    const PixelColour& c = photo.at(column, row);
    return Eigen::Vector3d(c[0], c[1], c[2]);
  };
  return (1 - t) * ((1 - s) * at_pixel(left, top) + s * at_pixel(right, top)) +
         t * ((1 - s) * at_pixel(left, bottom) + s * at_pixel(right, bottom));
}

/// What the photograph shows of a point.
struct SeenPoint {
  bool seen = false;
  std::optional<Eigen::Vector3d> colour;  ///< of a seen one that is safe from silhouettes
};

/// What the photograph shows of the surface.
class SeenSurface {
 public:
  SeenSurface(const View& view, const PixelImage& photo, const OneViewResult& result,
              const BakeOptions& options);

  /// @param normal   of the surface there, to the outside
  /// @param texture  its place in the picture
  [[nodiscard]] SeenPoint look_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                  const Eigen::Vector2d& texture) const;
  /// Texture coordinates of a point's own image.
  [[nodiscard]] Eigen::Vector2d projected(const Eigen::Vector3d& point) const {
    return (point.head<2>() - origin_).cwiseQuotient(size_);
  }
  [[nodiscard]] const Eigen::MatrixX3d& normals() const { return normals_; }

 private:
  void decide_outsides(const OneViewResult& result);
  void mark_silhouettes();
  [[nodiscard]] bool at_silhouette(int x, int y) const;
  /// Whether the photograph may show something else at a pixel: near a silhouette, or where the
  /// surface is thinner than a pixel.
  [[nodiscard]] bool is_unsafe(std::size_t pixel) const {
    return disagreement_ > 0 && (outer_[pixel] != 0 || !nearest_.covered(pixel));
  }
  /// Colour of the photograph at texture coordinates.
  [[nodiscard]] Eigen::Vector3d photo_of(const Eigen::Vector2d& texture) const {
    return photo_colour(
        photo_, {texture.x() * photo_.width - 0.5, (1 - texture.y()) * photo_.height - 0.5});
  }
  [[nodiscard]] std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * grid_.width + x;
  }

  const PixelImage& photo_;
  BakeOptions options_;
  Eigen::Vector2d origin_, size_;
  PixelGrid grid_;
  NearestTriangles nearest_;
  Eigen::MatrixX3d normals_;       ///< of the triangles, to the outside
  const std::vector<int>& patch_;  ///< of the triangles
  double disagreement_;            ///< of photograph and drawing (pixels)
  double behind_;
  std::vector<char> outer_;  ///< pixels so near to a silhouette that the photograph may be off
};

SeenSurface::SeenSurface(const View& view, const PixelImage& photo, const OneViewResult& result,
                         const BakeOptions& options)
    : photo_(photo),
      options_(options),
      origin_(view.picture.origin),
      size_(view.picture.size),
      normals_(triangle_normals(result.surface.mesh)),
      patch_(result.surface.patch),
      disagreement_(result.disagreement) {
  const TriMesh& mesh = result.surface.mesh;
  // A square grid over the picture, about as fine as its pixels.
  grid_.origin = origin_;
  grid_.pixel = size_.x() / photo.width;
  grid_.width = photo.width;
  grid_.height = static_cast<int>(std::ceil(size_.y() / grid_.pixel));
  nearest_ = nearest_triangles(mesh, grid_);
  behind_ = options.behind * bounding_box_diagonal(mesh.V);
  decide_outsides(result);
  mark_silhouettes();
}

/// Whether the surface ends beside a pixel, lies much deeper or higher there, or is of another
/// patch.
bool SeenSurface::at_silhouette(int x, int y) const {
  const std::size_t own = pixel(x, y);
  if (!nearest_.covered(own)) return false;
  const int patch = patch_[nearest_.triangle[own]];
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, grid_.height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, grid_.width - 1); ++i) {
      const std::size_t other = pixel(i, j);
      if (!nearest_.covered(other) || patch_[nearest_.triangle[other]] != patch ||
          std::abs(nearest_.depth[other] - nearest_.depth[own]) > behind_)
        return true;
    }
  }
  return false;
}

void SeenSurface::mark_silhouettes() {
  outer_.assign(nearest_.triangle.size(), 0);
  if (disagreement_ == 0) return;
  const double reach = disagreement_ + kMixed;
  const int most = static_cast<int>(reach);
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      if (!at_silhouette(x, y)) continue;
      for (int j = std::max(y - most, 0); j <= std::min(y + most, grid_.height - 1); ++j) {
        for (int i = std::max(x - most, 0); i <= std::min(x + most, grid_.width - 1); ++i) {
          if (std::hypot(i - x, j - y) <= reach) outer_[pixel(i, j)] = 1;
        }
      }
    }
  }
}

/// A connected surface has one outside.
void SeenSurface::decide_outsides(const OneViewResult& result) {
  const EdgeConnectivity edges(result.surface.mesh.F);
  const auto count = result.surface.mesh.triangle_count();
  DisjointSets parts(count);
  for (int h = 0; h < 3 * count; ++h)
    if (edges.twin(h) >= 0) parts.join(h / 3, edges.twin(h) / 3);
  std::vector<double> facing(count, 0);
  for (const int t : nearest_.triangle) {
    if (t >= 0) facing[parts.find(t)] += normals_(t, 2) > 0 ? 1 : -1;
  }
  for (int t = 0; t < count; ++t) {
    if (facing[parts.find(t)] < 0) normals_.row(t) *= -1;
  }
}

SeenPoint SeenSurface::look_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               const Eigen::Vector2d& texture) const {
  if (normal.z() < options_.least_facing) return {};
  const Eigen::Vector2d at = grid_.pixels_at(point.head<2>());
  const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  if (x < 0 || y < 0 || x >= grid_.width || y >= grid_.height) return {};
  if (nearest_.depth[pixel(x, y)] > point.z() + behind_) return {};
  // A place lies between four pixels.
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const int column = std::clamp(static_cast<int>(std::floor(at.x())) + i, 0, grid_.width - 1);
      const int row = std::clamp(static_cast<int>(std::floor(at.y())) + j, 0, grid_.height - 1);
      if (is_unsafe(pixel(column, row))) return {true, {}};
    }
  }
  return {true, photo_of(texture)};
}

/// The pieces of a pattern as one mesh in z = 0, with the places of its points in space.
struct PatternInSpace {
  TriMesh flat;
  std::vector<int> vertex;    ///< of the surface, of each point
  std::vector<int> triangle;  ///< of the surface, of each triangle
};

PatternInSpace merged_pieces(const Pattern& pattern) {
  PatternInSpace merged;
  Eigen::Index points = 0, triangles = 0;
  for (const PatternPiece& piece : pattern.pieces) {
    points += piece.points.rows();
    triangles += piece.triangles.rows();
  }
  merged.flat.V = Eigen::MatrixX3d::Zero(points, 3);
  merged.flat.F.resize(triangles, 3);
  Eigen::Index v = 0, t = 0;
  for (const PatternPiece& piece : pattern.pieces) {
    merged.flat.V.block(v, 0, piece.points.rows(), 2) = piece.points;
    merged.flat.F.middleRows(t, piece.triangles.rows()) =
        piece.triangles.array() + static_cast<int>(v);
    merged.vertex.insert(merged.vertex.end(), piece.surface_vertex.begin(),
                         piece.surface_vertex.end());
    merged.triangle.insert(merged.triangle.end(), piece.surface_triangle.begin(),
                           piece.surface_triangle.end());
    v += piece.points.rows();
    t += piece.triangles.rows();
  }
  return merged;
}

PixelGrid pattern_grid(const TriMesh& flat, double photo_pixel, const BakeOptions& o) {
  PixelGrid grid;
  const Eigen::Vector2d low = flat.V.leftCols<2>().colwise().minCoeff().transpose();
  const Eigen::Vector2d high = flat.V.leftCols<2>().colwise().maxCoeff().transpose();
  const Eigen::Vector2d size = high - low;
  const int rim = o.bleed + 1;
  grid.pixel = o.dpi ? kInch / *o.dpi
                     : std::max(photo_pixel, size.maxCoeff() / std::max(o.most_side - 2 * rim, 1));
  const Eigen::Vector2d pixels = (size / grid.pixel).array().ceil();
  if (!(pixels.maxCoeff() + 2 * rim <= kMostSide)) {
    throw Error(
        "the pattern's picture would be " + std::to_string(pixels.maxCoeff()) + " pixels large",
        "textures.dpi", "at most " + std::to_string(kMostSide));
  }
  grid.width = static_cast<int>(pixels.x()) + 2 * rim;
  grid.height = static_cast<int>(pixels.y()) + 2 * rim;
  grid.origin = low - grid.pixel * Eigen::Vector2d(rim, rim);
  return grid;
}

/// Where a pixel's colour comes from; `beside`: from what is around, as the photograph shows it too
/// near a silhouette.
enum class TexelSource : std::uint8_t { none, seen, mirrored, beside, flat };

class PatternBaker {
 public:
  PatternBaker(const SeenSurface& seen, const OneViewResult& result, const PatternInSpace& pieces,
               const PixelGrid& grid)
      : seen_(seen),
        result_(result),
        pieces_(pieces),
        grid_(grid),
        covered_(nearest_triangles(pieces.flat, grid)),
        colour_(covered_.triangle.size(), Eigen::Vector3d::Constant(255)),
        source_(covered_.triangle.size(), TexelSource::none) {}

  /// @param step, reach  of `continue_patches`; @param beyond  borders colours go on (pixels)
  BakedPattern bake(int step, double reach, int beyond);

 private:
  [[nodiscard]] int patch_at(std::size_t texel) const {
    const int t = pieces_.triangle[covered_.triangle[texel]];
    return result_.surface.patch[t];
  }
  void colour_texel(std::size_t texel);
  void continue_patches(int step, double reach);
  void fill_hidden();
  void bleed(int step, int pixels);

  const SeenSurface& seen_;
  const OneViewResult& result_;
  const PatternInSpace& pieces_;
  PixelGrid grid_;
  NearestTriangles covered_;
  std::vector<Eigen::Vector3d> colour_;
  std::vector<TexelSource> source_;
  /// What texels beside silhouettes are where no colour reaches them; `colour_` has a mirror
  /// image's.
  std::map<std::size_t, TexelSource> if_out_of_reach_;
};

void PatternBaker::colour_texel(std::size_t texel) {
  const TexturedSurface& surface = result_.surface;
  const int flat = covered_.triangle[texel];
  const int t = pieces_.triangle[flat];
  Eigen::Vector3d point(0, 0, 0);
  Eigen::Vector2d texture(0, 0);
  for (int k = 0; k < 3; ++k) {
    const int v = pieces_.vertex[pieces_.flat.F(flat, k)];
    point += covered_.weights[texel](k) * surface.mesh.V.row(v).transpose();
    texture += covered_.weights[texel](k) * surface.texture.row(v).transpose();
  }
  const MirrorPlane& plane = result_.planes.chosen;
  const auto reflected = [&](const Eigen::Vector3d& n) -> Eigen::Vector3d {
    return n - 2 * n.dot(plane.normal) * plane.normal;
  };
  Eigen::Vector3d normal = seen_.normals().row(t).transpose();
  if (surface.mirror_image[t]) {
    point = mirrored(plane, point);
    normal = reflected(normal);
  }
  const SeenPoint own = seen_.look_at(point, normal, texture);
  if (own.colour) {
    source_[texel] = TexelSource::seen;
    colour_[texel] = *own.colour;
    return;
  }
  const Eigen::Vector3d image = mirrored(plane, point);
  const SeenPoint other = seen_.look_at(image, reflected(normal), seen_.projected(image));
  if (other.colour) colour_[texel] = *other.colour;
  const TexelSource hidden = other.colour ? TexelSource::mirrored : TexelSource::flat;
  const bool beside = own.seen || (other.seen && !other.colour);
  source_[texel] = beside ? TexelSource::beside : hidden;
  if (beside) if_out_of_reach_.emplace(texel, hidden);
}

/// Colours beside silhouettes: those of the rest of their patch go on, on the cloth, where lines
/// are as straight as they were woven; out of reach they are what a hidden place has.
/// @param step, reach  of `ContinuedPatches`
void PatternBaker::continue_patches(int step, double reach) {
  if (if_out_of_reach_.empty()) return;
  ContinuedPatches patches(grid_.width, grid_.height, step,
                           static_cast<int>(result_.patches.size()));
  for (std::size_t i = 0; i < source_.size(); ++i) {
    if (source_[i] == TexelSource::seen || source_[i] == TexelSource::mirrored)
      patches.know(i, patch_at(i), colour_[i]);
  }
  for (const auto& [texel, hidden] : if_out_of_reach_) patches.want(texel, patch_at(texel));
  patches.fill(reach);
  for (const auto& [texel, hidden] : if_out_of_reach_) {
    if (const auto colour = patches.colour(texel, patch_at(texel))) {
      colour_[texel] = *colour;
    } else {
      source_[texel] = hidden;
    }
  }
}

/// Mean colours where nothing is seen.
void PatternBaker::fill_hidden() {
  std::vector<Eigen::Vector3d> sum(result_.patches.size(), Eigen::Vector3d::Zero());
  std::vector<double> count(result_.patches.size(), 0);
  Eigen::Vector3d all(0, 0, 0);
  double number = 0;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    if (source_[i] == TexelSource::none || source_[i] == TexelSource::flat) continue;
    const std::size_t p = patch_at(i);
    sum[p] += colour_[i];
    all += colour_[i];
    ++count[p];
    ++number;
  }
  for (std::size_t i = 0; i < source_.size(); ++i) {
    if (source_[i] != TexelSource::flat) continue;
    const std::size_t p = patch_at(i);
    if (count[p] > 0) {
      colour_[i] = sum[p] / count[p];
    } else if (number > 0) {
      colour_[i] = all / number;
    }
  }
}

/// Beyond the borders of pieces the colours of their patches go on, too.
/// @param pixels  beyond
void PatternBaker::bleed(int step, int pixels) {
  if (pixels == 0) return;
  std::vector<int> owner(source_.size(), -1);  // patch of a pixel, beyond that of its neighbour
  ContinuedPatches patches(grid_.width, grid_.height, step,
                           static_cast<int>(result_.patches.size()));
  std::vector<std::size_t> front, beyond;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    if (source_[i] == TexelSource::none) continue;
    owner[i] = patch_at(i);
    patches.know(i, owner[i], colour_[i]);
    front.push_back(i);
  }
  for (int k = 0; k < pixels; ++k) {
    std::vector<std::size_t> next;
    for (const std::size_t pixel : front) {
      const int x = static_cast<int>(pixel % grid_.width);
      const int y = static_cast<int>(pixel / grid_.width);
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, grid_.height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, grid_.width - 1); ++i) {
          const std::size_t other = static_cast<std::size_t>(j) * grid_.width + i;
          if (owner[other] >= 0) continue;
          owner[other] = owner[pixel];
          colour_[other] = colour_[pixel];
          next.push_back(other);
        }
      }
    }
    beyond.insert(beyond.end(), next.begin(), next.end());
    front = std::move(next);
  }
  for (const std::size_t pixel : beyond) patches.want(pixel, owner[pixel]);
  patches.fill(2.0 * (pixels + step) / step);
  for (const std::size_t pixel : beyond)
    if (const auto colour = patches.colour(pixel, owner[pixel])) colour_[pixel] = *colour;
}

BakedPattern PatternBaker::bake(int step, double reach, int beyond) {
  for (std::size_t i = 0; i < source_.size(); ++i)
    if (covered_.covered(i)) colour_texel(i);
  continue_patches(step, reach);
  BakedPattern baked;
  baked.grid = grid_;
  double all = 0;
  for (const TexelSource source : source_) {
    all += source != TexelSource::none ? 1 : 0;
    baked.seen += source == TexelSource::seen ? 1 : 0;
    baked.mirrored += source == TexelSource::mirrored ? 1 : 0;
    baked.continued += source == TexelSource::beside ? 1 : 0;
    baked.flat += source == TexelSource::flat ? 1 : 0;
  }
  for (double* share : {&baked.seen, &baked.mirrored, &baked.continued, &baked.flat})
    *share /= std::max(all, 1.0);
  fill_hidden();
  bleed(step, beyond);
  baked.image = {grid_.width, grid_.height, {}};
  for (const Eigen::Vector3d& c : colour_) baked.image.pixels.push_back(rounded_colour(c));
  return baked;
}

}  // namespace

void describe(OptionVisitor& v, BakeOptions& o) {
  v.value("dpi", o.dpi,
          {.doc = "resolution of the pattern's picture; absent: about the photograph's own",
           .unit = "1/inch",
           .min = 1,
           .max = 1200});
  v.value("most_side", o.most_side,
          {.doc = "pixels of the picture's longer side, without dpi", .min = 64, .max = kMostSide});
  v.value("bleed", o.bleed,
          {.doc = "pixels that colours go on beyond the border", .min = 0, .max = 64});
  v.value("least_facing", o.least_facing,
          {.doc = "cosine to the eye below which a side is not read", .min = 0, .max = 1});
  v.value("behind", o.behind,
          {.doc = "depth by which what hides must be nearer, over the surface's diagonal",
           .min = 0,
           .max = 1});
}

BakedPattern bake_pattern(const View& view, const PixelImage& photo, const OneViewResult& result,
                          const Pattern& pattern, const BakeOptions& options) {
  const SeenSurface seen(view, photo, result, options);
  const PatternInSpace pieces = merged_pieces(pattern);
  const double photo_pixel = view.picture.size.x() / photo.width;
  const PixelGrid grid = pattern_grid(pieces.flat, photo_pixel, options);
  const int step = std::max(1, static_cast<int>(photo_pixel / grid.pixel));
  // On the pattern, what is seen at a slant is longer than in the picture.
  constexpr double kReach = 4, kLeastFacing = 0.05;
  const double reach = kReach * (result.disagreement + kMixed) /
                       std::max(options.least_facing, kLeastFacing) * photo_pixel /
                       (step * grid.pixel);
  return PatternBaker(seen, result, pieces, grid).bake(step, reach, options.bleed);
}

}  // namespace geoprior::sketch
