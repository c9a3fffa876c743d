#pragma once

#include <array>

#include "testbed/view/panel/content.h"

class vtkActor;

namespace geoprior {

enum class WaterTint { none, all, but_ground };

/// Shades a surface as water, pixel by pixel: it reflects a bright sky as Fresnel's law says
/// (Schlick's form), the sun as a highlight, and shows a body that is deeper in colour where one
/// looks down into it. A coloured surface keeps its colours as a tint of the body.
/// @param tint    whether the actor's scalars are mapped to colours that tint the body, everywhere
///                or where they are another than `ground`
void shade_as_water(vtkActor* actor, const ViewWindow& window, WaterTint tint,
                    const std::array<double, 3>& ground);

}  // namespace geoprior
