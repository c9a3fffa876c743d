#pragma once

#include "core/frame.h"
#include "models/assembly/search/input.h"

namespace geoprior::assembly {

/// The catalogue and the models as a program from outside is given them. Kinds of parts are numbers
/// from 0 on; what belongs to a kind is in its own coordinates (m).
///
/// Parts: `bodies` (triangles of all kinds; cells `label`, the kind, with the labels of all);
/// `ways` (lines; cells `type`, and the ports `from`, `to`, -1: inside). Tables, frames and motions
/// as 3 x 4: `ports` (type, port, class, frame; ports of a class are alike, by a symmetry of their
/// kind), `boxes` (type, half lengths, frame), `symmetries` (type, motion), and the models, a
/// model's number before what a frame's tables say: `parts`, `connections`.
Frame given_frame(const AssemblyInput& input);

}  // namespace geoprior::assembly
