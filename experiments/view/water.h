#pragma once

#include "experiments/view/panel.h"

class vtkActor;

namespace geoprior {

/// Shades a surface as water, pixel by pixel: it reflects a bright sky as Fresnel's law says
/// (Schlick's form), the sun as a highlight, and shows a body that is deeper in colour where one
/// looks down into it. A coloured surface keeps its colours as a tint of the body.
/// @param colored  the actor's scalars are mapped to colours
void shade_as_water(vtkActor* actor, const ViewWindow& window, bool colored);

}  // namespace geoprior
