#pragma once

#include <string>

#include "core/frame.h"

class vtkPolyData;
template <class T>
class vtkSmartPointer;

namespace geoprior {

/// Whether a surface says itself where it is smooth: a point array "normal" (3).
bool has_normals(const Part& part);

/// What is drawn for a part: a surface with smooth normals (its own, if it has them), tubes,
/// spheres, a plane or an iso-surface. The array `color_by` (may be empty) becomes the active
/// scalars where the part has it.
/// @param thickness_m  diameter of tubes, radius of spheres
/// @param flat         a surface without normals: each triangle has one tone
vtkSmartPointer<vtkPolyData> to_drawable(const Part& part, const std::string& color_by,
                                         double thickness_m, bool flat);

}  // namespace geoprior
