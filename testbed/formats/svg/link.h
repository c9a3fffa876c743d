#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace geoprior {

/// Bytes that a link holds itself: "data:image/png;base64,…".
struct SvgData {
  std::string media_type;  ///< "image/png"
  std::string bytes;
};

bool is_data_link(std::string_view href);

/// @throws Error  at `where`: no comma, no base64
SvgData parse_data_link(std::string_view href, const std::string& where);

/// The file that a link of a document in `folder` names, which lies below that folder: a relative
/// path, percent-encoded or not, or "file://" with an absolute one. It need not be there.
/// @throws Error  at `where`: another scheme, a path that leaves the folder, a symbolic link on it
std::filesystem::path file_of_link(std::string_view href, const std::filesystem::path& folder,
                                   const std::string& where);

}  // namespace geoprior
