#include "experiments/sketch/truth/known_photo.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "solvers/sketch/photo/nearest_triangles.h"

namespace geoprior::sketch {
namespace {

/// Samples along a side of a pixel.
constexpr int kSuperSamples = 3;

/// How a panel looks: its cloth, and lines printed or sewn on it.
struct PanelMaterial {
  Eigen::Vector3d cloth{0.5, 0.5, 0.5};
  Eigen::Vector3d print{0.3, 0.3, 0.3};
  double along = 0;    ///< distance of lines across the first coordinate (m); 0: none
  double across = 0;   ///< … across the second
  double width = 0.1;  ///< of a line, over that distance
  bool slanted = false;
};

PanelMaterial bag_material(const std::string& panel) {
  const Eigen::Vector3d leather(0.72, 0.4, 0.2), thread(0.93, 0.78, 0.52), dark(0.45, 0.22, 0.11);
  if (panel == "gusset") return {dark, thread, 0.02, 0.045, 0.07, false};
  if (panel == "flap") return {leather * 1.12, dark, 0.03, 0.03, 0.09, true};
  if (panel == "strap") return {dark, thread, 0, 0.013, 0.12, false};
  return {leather, thread, 0.04, 0.04, 0.06, true};
}

PanelMaterial tent_material(const std::string& panel) {
  const Eigen::Vector3d canvas(0.86, 0.52, 0.14), blue(0.16, 0.33, 0.52), white(1.0, 0.98, 0.92);
  if (panel == "room") return {canvas, white, 0.15, 0.25, 0.1, false};
  if (panel == "flat-door") return {white, blue, 0.18, 0, 0.06, false};
  return {blue, white, 0.15, 0, 0.12, false};
}

PanelMaterial helmet_material(const std::string& panel) {
  const Eigen::Vector3d steel(0.62, 0.65, 0.7), brass(0.8, 0.62, 0.28), dark(0.24, 0.25, 0.29);
  if (panel == "brow-band") return {brass, dark, 0.02, 0.025, 0.12, true};
  if (panel == "comb") return {brass, dark, 0.02, 0, 0.15, false};
  if (panel == "brim") return {steel * 0.9, dark, 0.03, 0, 0.05, false};
  return {steel, dark, 0.035, 0.03, 0.05, false};
}

PanelMaterial paper_material() {
  return {{0.9, 0.84, 0.7}, {0.62, 0.4, 0.3}, 0.03, 0.03, 0.1, true};
}

PanelMaterial material_of(KnownShape shape, const std::string& panel) {
  return shape == KnownShape::bag      ? bag_material(panel)
         : shape == KnownShape::tent   ? tent_material(panel)
         : shape == KnownShape::helmet ? helmet_material(panel)
                                       : paper_material();
}

/// Flat coordinates of the vertices of `panel_mesh`.
Eigen::MatrixX2d cloth_coordinates(const KnownPanel& panel, const TriMesh& mesh) {
  Eigen::MatrixX2d uv(mesh.V.rows(), 2);
  if (panel.flat) {
    // Known flat panels face the front: x and y are coordinates in their plane.
    uv = mesh.V.leftCols<2>();
    return uv;
  }
  std::vector<double> length{0};
  for (std::size_t k = 1; k < panel.first.size(); ++k)
    length.push_back(length.back() + (panel.first[k] - panel.first[k - 1]).norm());
  for (std::size_t k = 0; k < panel.first.size(); ++k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    const double s = length[k] - length.back() / 2;
    uv.row(row) << s, 0;
    uv.row(row + 1) << s, (panel.second[k] - panel.first[k]).norm();
  }
  return uv;
}

/// 1 on a line, 0 off it, with a soft edge.
double on_line(double x, double period, double width) {
  if (!(period > 0)) return 0;
  const double phase = std::abs(x / period - std::round(x / period));
  return std::clamp((width / 2 - phase) / (0.25 * width) + 0.5, 0.0, 1.0);
}

Eigen::Vector3d printed_colour(const PanelMaterial& m, const Eigen::Vector2d& uv) {
  const double x = m.slanted ? (uv.x() + uv.y()) / std::sqrt(2.0) : uv.x() + m.along / 2;
  const double y = m.slanted ? (uv.x() - uv.y()) / std::sqrt(2.0) : uv.y() + m.across / 2;
  const double ink = std::max(on_line(x, m.along, m.width), on_line(y, m.across, m.width));
  return (1 - ink) * m.cloth + ink * m.print;
}

/// Light of a high window on a side that may be turned either way to the eye.
double light_on(Eigen::Vector3d normal) {
  const Eigen::Vector3d window = Eigen::Vector3d(0.45, 0.75, 0.6).normalized();
  if (normal.z() < 0) normal = -normal;
  const double half = 0.5 + 0.5 * normal.dot(window);
  return 0.42 + 0.68 * half * half;
}

std::uint8_t byte_of(double linear) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(linear, 0.0, 1.0)));
}

/// The backdrop, lighter towards the top.
Eigen::Vector3d backdrop(double up) {
  return Eigen::Vector3d(0.80, 0.81, 0.83) + 0.14 * up * Eigen::Vector3d(1, 1, 1);
}

/// Colours of fine samples, averaged over pixels.
PixelImage averaged(const std::vector<Eigen::Vector3d>& fine, int width, int height) {
  PixelImage image{width, height, {}};
  image.pixels.resize(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Eigen::Vector3d sum(0, 0, 0);
      for (int j = 0; j < kSuperSamples; ++j) {
        for (int i = 0; i < kSuperSamples; ++i) {
          const int row = y * kSuperSamples + j, column = x * kSuperSamples + i;
          sum += fine[row * width * kSuperSamples + column];
        }
      }
      sum /= kSuperSamples * kSuperSamples;
      image.at(x, y) = {byte_of(sum.x()), byte_of(sum.y()), byte_of(sum.z())};
    }
  }
  return image;
}

}  // namespace

PixelImage known_photo(KnownShape shape, const KnownObject& object, int width) {
  const KnownPlacement place = known_placement(object);
  const PlacedPanels panels = placed_panels(object, place);
  Eigen::MatrixX2d cloth(panels.mesh.V.rows(), 2);
  std::vector<PanelMaterial> materials;
  Eigen::Index row = 0;
  for (const KnownPanel& panel : object.panels) {
    const Eigen::MatrixX2d uv = cloth_coordinates(panel, panel_mesh(panel));
    cloth.middleRows(row, uv.rows()) = uv;
    row += uv.rows();
    materials.push_back(material_of(shape, panel.name));
  }
  const int height = static_cast<int>(std::lround(width * place.page.y() / place.page.x()));
  const PixelGrid grid{{0, 0},
                       place.page.x() / (width * kSuperSamples),
                       width * kSuperSamples,
                       height * kSuperSamples};
  const NearestTriangles seen = nearest_triangles(panels.mesh, grid);
  const Eigen::MatrixX3d normals = triangle_normals(panels.mesh);
  std::vector<Eigen::Vector3d> fine;
  for (std::size_t i = 0; i < seen.triangle.size(); ++i) {
    if (!seen.covered(i)) {
      const auto line = i / grid.width;
      fine.push_back(backdrop(1 - static_cast<double>(line) / grid.height));
      continue;
    }
    const int t = seen.triangle[i];
    Eigen::Vector2d uv(0, 0);
    for (int k = 0; k < 3; ++k)
      uv += seen.weights[i](k) * cloth.row(panels.mesh.F(t, k)).transpose();
    const PanelMaterial& m = materials[panels.panel[t]];
    fine.push_back(printed_colour(m, uv) * light_on(normals.row(t).transpose()));
  }
  return averaged(fine, width, height);
}

}  // namespace geoprior::sketch
