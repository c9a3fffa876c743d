#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// The standard streams of the program: words for people go to stderr, results for programs to
/// stdout. What people read is never an error when it cannot be written, what programs read always.

/// Opens /dev/null in the place of closed standard streams, so that no file that is opened later is
/// taken for one of them. Writing to a stdout that was closed stays an error. First of all in main.
void reserve_standard_streams();

/// Writes a line to stderr, `printable` but for the colours of `tinted`.
void say(std::string_view line = {});

/// Writes results to stdout. @throws Error  with the system's reason: disk full, closed pipe …
void print_out(std::string_view text);

/// The text as UTF-8 that a terminal does not obey: bytes that are no UTF-8, control characters and
/// those that turn the direction of writing become "\xNN". Line ends and tabs stay.
std::string printable(std::string_view text);

/// Length of the character that the text begins with, where a line may show it: UTF-8, no control
/// character, line end or tab; else 0.
std::size_t printable_length(std::string_view text);

/// Each byte as "\xNN".
std::string escaped_bytes(std::string_view bytes);

/// The bytes that `printable` made the text of, where they had no "\xNN" of their own.
std::string from_printable(std::string_view text);

}  // namespace geoprior
