#pragma once

#include <vector>

#include "core/frame.h"
#include "experiments/embryo/scene/scene.h"
#include "models/embryo/surface/mesh.h"
#include "solvers/embryo/state/development.h"

namespace geoprior::embryo {

/// A structure code as an array whose codes have names: the labels of the scene's structures.
NamedArray structure_array(const EmbryoScene& scene, NamedArray::On on, Eigen::VectorXd codes);

/// One surface of meshes, with what each triangle belongs to and what kind of thing that is.
Part surface_part(const EmbryoScene& scene, const std::vector<StructureMesh>& meshes);

/// A day as all methods of the topic record it: surface, centre lines of ducts, landmarks, and the
/// tables of structures, processes and the body.
Frame day_frame(const EmbryoScene& scene, const DayState& state,
                const std::vector<StructureMesh>& meshes);

/// The structures of a day that the scene wants a surface of.
DayState wanted(const EmbryoScene& scene, const DayState& state);

}  // namespace geoprior::embryo
