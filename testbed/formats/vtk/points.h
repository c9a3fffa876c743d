#pragma once

#include <vtkPoints.h>
#include <vtkSmartPointer.h>

#include <Eigen/Core>

namespace geoprior {

/// The rows of `V` as points of double precision.
inline vtkSmartPointer<vtkPoints> to_vtk_points(const Eigen::MatrixX3d& V) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(V.rows());
  for (Eigen::Index i = 0; i < V.rows(); ++i) points->SetPoint(i, V(i, 0), V(i, 1), V(i, 2));
  return points;
}

}  // namespace geoprior
