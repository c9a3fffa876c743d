#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "models/sketch/drawing/drawing.h"
#include "testbed/formats/svg/document.h"

namespace geoprior::sketch {

/// What comes before the pixels of a picture: its first million bytes.
/// @throws Error  naming the file: missing, unreadable
std::string head_of_picture(const std::filesystem::path& file);

/// Pixels that the head of a PNG or JPEG picture tells, width and height; absent for what is
/// neither, or is cut off before. Nothing is decoded.
///
/// @param bytes  the picture; of a JPEG all of it up to its frame header
/// Source: PNG, 11.2.1 (W3C 2003); JPEG, B.2.2 (ITU-T T.81).
std::optional<Eigen::Vector2i> picture_size(std::string_view bytes);

/// A picture of a drawing where it is seen: fitted into its box as `preserveAspectRatio` says.
/// @throws Error  at `where`: the file is missing or no PNG or JPEG; the picture is turned,
///                mirrored, or cut off by its box
Picture view_picture(const SvgImage& image, const std::string& where);

/// Gives the one view of a drawing another picture: in the place of its own, or over the whole page
/// where it has none.
/// @param page    size of it (m); 0: unknown
/// @throws Error  naming the file: the drawing has several views, the file is neither PNG nor JPEG,
///                its proportions are not those of the place (by more than 1 percent), or there is
///                no place
void replace_picture(Drawing& drawing, const std::filesystem::path& file,
                     const Eigen::Vector2d& page);

}  // namespace geoprior::sketch
