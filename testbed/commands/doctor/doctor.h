#pragma once

#include "testbed/commands/commands.h"

namespace geoprior {

/// `geoprior doctor`: what of the machine is there, what each thing is for and how to get it.
/// @return  `fell_short` where something is missing that the main job needs
int doctor_command(const CommandContext& context);

}  // namespace geoprior
