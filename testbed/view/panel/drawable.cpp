#include "testbed/view/panel/drawable.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkContourFilter.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3D.h>
#include <vtkImageData.h>
#include <vtkImageDataGeometryFilter.h>
#include <vtkNew.h>
#include <vtkOutlineSource.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTubeFilter.h>

#include "core/geometry/topology.h"
#include "core/mesh.h"
#include "testbed/formats/vtk/points.h"
#include "testbed/view/figure/colors.h"

namespace geoprior {
namespace {

vtkSmartPointer<vtkDoubleArray> to_array(const Eigen::VectorXd& values, const std::string& name) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name.c_str());
  array->SetNumberOfValues(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) array->SetValue(i, values[i]);
  return array;
}

void add_scalars(const Part& part, const std::string& color_by, vtkDataSet* data) {
  const NamedArray* array = color_by.empty() ? nullptr : part.find_array(color_by);
  if (array == nullptr) return;
  const auto values = to_array(scalars(*array), color_by);
  if (array->on == NamedArray::On::points) {
    data->GetPointData()->SetScalars(values);
  } else {
    data->GetCellData()->SetScalars(values);
  }
}

vtkSmartPointer<vtkPolyData> with_points(const Part& part) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(to_vtk_points(part.points));
  return data;
}

constexpr const char* kNormal = "normal";

/// The part's own, or those of the welded surface, so that texture seams do not show as creases.
Eigen::MatrixX3d smooth_normals(const Part& part) {
  if (has_normals(part)) return part.find_array(kNormal, NamedArray::On::points)->values;
  const Weld weld = weld_by_position({part.points, part.triangles});
  const Eigen::MatrixX3d welded = vertex_normals(weld.mesh);
  Eigen::MatrixX3d normals(part.points.rows(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    normals.row(i) = welded.row(weld.welded_of_split[i]);
  }
  return normals;
}

vtkSmartPointer<vtkPolyData> surface(const Part& part, const std::string& color_by, bool flat) {
  auto data = with_points(part);
  vtkNew<vtkCellArray> triangles;
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    triangles->InsertNextCell({part.triangles(t, 0), part.triangles(t, 1), part.triangles(t, 2)});
  }
  data->SetPolys(triangles);
  add_scalars(part, color_by, data);
  if (flat) return data;
  const Eigen::MatrixX3d normals = smooth_normals(part);
  vtkNew<vtkDoubleArray> array;
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(normals.rows());
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    array->SetTuple3(i, normals(i, 0), normals(i, 1), normals(i, 2));
  }
  data->GetPointData()->SetNormals(array);
  return data;
}

vtkSmartPointer<vtkPolyData> tubes(const Part& part, const std::string& color_by,
                                   double thickness) {
  auto data = with_points(part);
  vtkNew<vtkCellArray> lines;
  for (const std::vector<int>& line : part.lines) {
    lines->InsertNextCell(static_cast<int>(line.size()));
    for (const int point : line) lines->InsertCellPoint(point);
  }
  data->SetLines(lines);
  add_scalars(part, color_by, data);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputData(data);
  tube->SetRadius(thickness / 2);
  tube->SetNumberOfSides(16);
  tube->CappingOn();
  tube->Update();
  return tube->GetOutput();
}

vtkSmartPointer<vtkPolyData> spheres(const Part& part, const std::string& color_by,
                                     double thickness) {
  auto data = with_points(part);
  add_scalars(part, color_by, data);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(thickness);
  sphere->SetThetaResolution(20);
  sphere->SetPhiResolution(20);
  vtkNew<vtkGlyph3D> glyphs;
  glyphs->SetInputData(data);
  glyphs->SetSourceConnection(sphere->GetOutputPort());
  glyphs->ScalingOff();
  glyphs->SetColorModeToColorByScalar();
  glyphs->Update();
  return glyphs->GetOutput();
}

/// The level drawn of a scalar field: 0 of a signed one (a distance), half-way of the others.
double iso_level(const Eigen::VectorXd& values) {
  const double low = values.minCoeff();
  const double high = values.maxCoeff();
  return low < 0 && high > 0 ? 0 : (low + high) / 2;
}

vtkSmartPointer<vtkPolyData> grid(const Part& part, const std::string& color_by) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(part.grid_size.data());
  image->SetOrigin(part.grid_origin.x(), part.grid_origin.y(), part.grid_origin.z());
  image->SetSpacing(part.grid_spacing.x(), part.grid_spacing.y(), part.grid_spacing.z());
  add_scalars(part, color_by, image);
  bool flat = false;
  for (const int n : part.grid_size) flat = flat || n == 1;
  if (flat) {
    vtkNew<vtkImageDataGeometryFilter> plane;
    plane->SetInputData(image);
    plane->Update();
    return plane->GetOutput();
  }
  for (const NamedArray& array : part.arrays) {
    if (array.on != NamedArray::On::points || array.values.cols() != 1) continue;
    image->GetPointData()->SetScalars(to_array(array.values.col(0), array.name));
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(image);
    contour->SetValue(0, iso_level(array.values.col(0)));
    contour->ComputeNormalsOn();
    contour->ComputeScalarsOff();
    contour->Update();
    return contour->GetOutput();
  }
  vtkNew<vtkOutlineSource> outline;
  outline->SetBounds(image->GetBounds());
  outline->Update();
  return outline->GetOutput();
}

}  // namespace

bool has_normals(const Part& part) {
  const NamedArray* array = part.find_array(kNormal, NamedArray::On::points);
  return part.kind == Part::Kind::triangles && array != nullptr && array->values.cols() == 3;
}

vtkSmartPointer<vtkPolyData> to_drawable(const Part& part, const std::string& color_by,
                                         double thickness_m, bool flat) {
  switch (part.kind) {
    case Part::Kind::triangles:
      return surface(part, color_by, flat);
    case Part::Kind::lines:
      return tubes(part, color_by, thickness_m);
    case Part::Kind::points:
      return spheres(part, color_by, thickness_m);
    case Part::Kind::grid:
      break;
  }
  return grid(part, color_by);
}

}  // namespace geoprior
