#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "testbed/view/figure/colors.h"
#include "testbed/view/panel/content.h"

class vtkActor;
template <class T>
class vtkSmartPointer;

namespace geoprior {

/// Radius of the balls that points over a part are drawn as (m).
double overlay_ball_radius(const ViewWindow& window);

/// What a panel is made of, ready to be drawn.
struct PanelActors {
  std::vector<vtkSmartPointer<vtkActor>> opaque;
  std::vector<vtkSmartPointer<vtkActor>> faint;  ///< obstacles: they shade nothing
};

/// @param pixels_per_pixel  supersampling: lines are as many times as wide
PanelActors make_actors(const PanelParts& parts, const ViewWindow& window, const PanelStyle& style,
                        int pixels_per_pixel);

}  // namespace geoprior
