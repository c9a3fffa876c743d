#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace geoprior {

/// What errors of WAV files say is read.
inline constexpr const char* kAllowedWav = "a WAV file of 16, 24 or 32-bit PCM or floating point";

/// The same sound as a WAV file of two chunks, `fmt ` and `data`, of right sizes.
///
/// Read are RIFF, RIFX (its numbers are big-endian), RF64 and BW64 (sizes of 64 bits in the chunk
/// `ds64`). Chunks come in any order; others are stepped over, odd ones with the byte that pads
/// them or without. What a program wrote that could not go back to its head (a pipe: a size of 0,
/// of 2^32 - 1, or of 2^31 - 2^12 and more that is not there) goes on to the end of the file.
///
/// @param name   of the file, for errors
/// @param notes  added: that the size was not in the head
/// @throws Error  naming the file: empty, no WAV file, cut short, no format, no samples, of 4 GB
/// Source: RIFF (IBM and Microsoft 1991); EBU Tech 3306 (RF64); ITU-R BS.2088 (BW64).
std::vector<std::byte> plain_wav(std::span<const std::byte> bytes, const std::string& name,
                                 std::vector<std::string>& notes);

}  // namespace geoprior
