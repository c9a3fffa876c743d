#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// The files of the pieces of a .pvtp, beside it unless they are absolute.
/// @throws Error  naming file and byte: no XML, no pieces, a piece without a file
std::vector<std::filesystem::path> pvtp_pieces(const std::filesystem::path& file);
std::vector<std::filesystem::path> parse_pvtp(std::string_view text,
                                              const std::filesystem::path& file);

/// Where a file lies that another one names: beside it unless it is absolute. Backslashes part
/// folders, as Windows writes them, unless there is a file with them in its name.
std::filesystem::path named_in(const std::filesystem::path& file, const std::string& name);

}  // namespace geoprior
