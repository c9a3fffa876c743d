#pragma once

#include "models/paper/sheet/pattern.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"

namespace geoprior::sound {

// What sound takes from paper: the sheet that is heard.
using paper::Handle;
using paper::Obstacle;
using paper::PaperMaterial;
using paper::Pattern;
using paper::Sheet;
using paper::ShellMesh;
using paper::ShellState;

}  // namespace geoprior::sound
