#pragma once

#include <vector>

#include "core/options.h"
#include "models/assembly/exchange/replacement.h"

namespace geoprior::assembly {

/// Most a joint may be off.
struct JointTolerance {
  double translation = 1e-6;  ///< m
  double angle_deg = 1e-4;
};
void describe(OptionVisitor& v, JointTolerance& options);

/// Whether a misfit is within a tolerance.
bool within(const Misfit& misfit, const JointTolerance& tolerance);

/// What of the misfit the new joints cannot escape: seams whose outer ends hang together outside
/// have given positions to one another, and so have the inner ends of the donor's substructure. The
/// largest misfit after the two are laid on each other at the first seam of each such group; zero
/// for a boundary of bridges. Needs no assembly to be built.
///
/// @param outside  for each boundary connection of the host, the piece of what stays that its outer
///                 end is in (`pieces_outside`)
Misfit seam_residual(const Assembly& host, const Assembly& donor,
                     const std::vector<PartType>& types, const Replacement& replacement,
                     const std::vector<int>& outside);

/// Moves rigid pieces into place: the largest component of what stays does not move, the copied
/// parts follow it at their first seam, the other components follow these. Within a piece parts
/// keep their relative poses, with the misfits that the host or the donor had there.
void embed(Replaced& replaced, const std::vector<PartType>& types);

/// Spreads misfits over all joints: Gauss-Newton on the poses, SE(3) each, of the sum over joints
/// of |translation / t|^2 + |angle / a|^2, t and a of the tolerance; the first part of each
/// component stays. Joints that no loop runs through stay closed.
///
/// @return  the largest of translation and angle over the joints afterwards
Misfit relax(Assembly& assembly, const std::vector<PartType>& types,
             const JointTolerance& tolerance);

/// Largest translation and largest angle.
Misfit largest(const std::vector<Misfit>& misfits);

}  // namespace geoprior::assembly
