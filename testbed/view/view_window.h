#pragma once

#include <vector>

#include "core/frame.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/view/panel/content.h"

namespace geoprior {

/// The window that shows all of the parts, or the part of space that the view asks for: one for all
/// panels, as narrow as what is drawn in it allows.
/// @throws Error  when direction or up is zero or they are parallel, or there is nothing to draw
ViewWindow fit_window(const std::vector<const Part*>& parts, const FigureView& view);

/// The window of the same size that looks at the cutting plane of a section from the front.
ViewWindow section_window(const ViewWindow& window, const SectionView& section);

/// Points that bound a part: its points, or the corners of a grid.
Eigen::MatrixX3d extent_points(const Part& part);

}  // namespace geoprior
