#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/assembly/files/read_result.h"

namespace geoprior::assembly {

/// Versions of the format that are read: those of XTrackCAD 2.1 to 4.2. Version 12 has other
/// records for ends and notes.
inline constexpr int kOldestXtrackcad = 7;
inline constexpr int kNewestXtrackcad = 10;

/// Reads model railways drawn with XTrackCAD (.xtc) into one catalogue: an assembly a file, named
/// after it, a part for each TURNOUT, STRAIGHT, CURVE, JOINT and TURNTABLE. Everything lies in the
/// plane z = 0: elevations are not read.
///
/// - A part's frame is that of its port 0 turned by half a turn: its x axis points into the part.
///   Ports are in the file's order, but a curve's begin where the track turns left from.
/// - Turnouts are labelled by their title, of which blanks in a row become one; flexible track by
///   its measures ("straight 3.61 in", "curve r 18.00 in 30.0 deg"). A part whose gauge or whose
///   ports differ from those of the first part of its label (by more than .02 inch or half a
///   degree) gets a further label, "... (2)".
/// - Symmetries are left empty. Numbers of a file are rounded, and hobbyists close gaps by force:
///   how well the parts meet is told by `joint_misfits`.
/// - Warned of: records that are no track, ends joined with what does not join them back, tracks
///   joined with themselves, unknown scales, and tracks of one type that lie on one another (levels
///   of a layout): these are lifted by .01 mm, as a place is for one part of a type.
///
/// @throws Error  naming file and line: unreadable, no or another version, cut in half, two tracks
///                of one number, a number that is missing, not finite or beyond 1e7 inches, a
///                straight, curve or joint whose ends are not two, a track of more than 1000 ends
ReadAssemblies read_xtrackcad(const std::vector<std::filesystem::path>& files);

/// Adds one layout. @param name  of its file, for messages; its stem is the name of the assembly
void read_xtrackcad_text(std::string_view text, const std::string& name, ReadAssemblies& into);

}  // namespace geoprior::assembly
