#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "models/sound/animation.h"
#include "models/sound/sheet.h"
#include "testbed/formats/sequence/files.h"

namespace geoprior::sound {

/// The frames of an animated sheet, and which of them are looked at.
struct SheetFileOptions {
  SequenceOptions sequence;
  int every = 1;
};
void describe(OptionVisitor& v, SheetFileOptions& options);

/// An animated sheet on disk, read frame by frame: .vtp files with the point array "pattern" (m),
/// as the frames of a run have, or .obj files with texture coordinates, which are those of the
/// pattern in the unit of the file. Beside the part "surface" of a run's frame its part "tears"
/// says where the sheet has torn, when it is there.
///
/// @param folder    of the experiment file, against which relative files are tried first
/// @param pattern   of the scene's sheet, which that of the frames must be
/// @param warnings  added: as by `open_sequence`
/// @param inputs    added: every file that it may read
/// @throws Error    as `open_sequence`, and for frames without coordinates of the pattern, or with
///                  those of another sheet: their bounding box differs from the pattern's by more
///                  than a hundredth of its width. First, middle and last frame are read here.
std::shared_ptr<const SheetAnimation> open_sheet_files(const SheetFileOptions& options,
                                                       const std::filesystem::path& folder,
                                                       const Pattern& pattern,
                                                       std::vector<std::string>& warnings,
                                                       std::vector<std::filesystem::path>& inputs);

}  // namespace geoprior::sound
