#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace geoprior {

/// The one door for text that a person or another program wrote: UTF-8 without its byte order mark,
/// and lines that end in \n, whichever of \n, \r\n and \r ended them. Lines keep their numbers.
///
/// @param name    of the file, for messages
/// @throws Error  for UTF-16 and UTF-32, with or without a byte order mark
std::string plain_text(std::string bytes, const std::string& name);

/// The same of a file; every reader of text begins here. @throws Error  also when it is unreadable
std::string read_text_file(const std::filesystem::path& file);

/// The bytes behind a byte order mark of UTF-8, for files of text and binary data together.
/// @throws Error  as `plain_text`
std::string_view without_byte_order_mark(std::string_view bytes, const std::string& name);

}  // namespace geoprior
