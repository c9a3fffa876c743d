#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/inputs/sound.h"

namespace geoprior {

/// A sound as a WAV file: RIFF, 24-bit PCM, the same bytes for the same sound.
///
/// A sample x is stored as round(2^23 x), at most 2^23 − 1, without dither: what is read back is x
/// to 2^-24, and exactly where x is a multiple of 2^-23 (+1 comes back as 1 − 2^-23).
///
/// @throws Error  naming sample and channel where |x| > 1 (it would clip) or x is not finite; for
/// no samples, more than kMostChannels, a sample rate out of range, or more bytes than RIFF counts
std::vector<std::byte> wav_bytes(const Sound& sound);

/// Channels that are read and written.
inline constexpr int kMostChannels = 8;

/// The sound of a WAV file of 16, 24 or 32-bit PCM, or 32 or 64-bit floating point. Floating point
/// may lie beyond ±1.
///
/// @param notes    added: what its head left open (wav_chunks.h)
/// @throws Error  naming the file: missing, no WAV, cut short, without samples, of 8 bits (its
/// steps are louder than what decays) or packed otherwise, a sample that is not finite, more than
/// kMostChannels, a sample rate out of range
Sound read_wav(const std::filesystem::path& file, std::vector<std::string>& notes);

/// The same, of bytes in memory; `name` is what errors and notes call them.
Sound wav_from_bytes(std::span<const std::byte> bytes, const std::string& name,
                     std::vector<std::string>& notes);
Sound wav_from_bytes(std::span<const std::byte> bytes, const std::string& name);

}  // namespace geoprior
