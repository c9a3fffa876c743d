#pragma once

#include <filesystem>
#include <fstream>

namespace geoprior {

/// Refuses what is no regular file (or a link to one): a pipe waits for its writer, a device need
/// not end.
/// @throws Error  naming the file and what it is
void require_regular_file(const std::filesystem::path& file);

/// The bytes of a regular file, opened for reading. Every input that is read as a stream is opened
/// here. @throws Error  naming the file and the reason
std::ifstream open_input_file(const std::filesystem::path& file);

}  // namespace geoprior
