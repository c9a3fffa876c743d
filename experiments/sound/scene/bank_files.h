#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/sound/voices/bank.h"

namespace geoprior::sound {

/// Reads a bank: "bank.csv" has a row a sound, with the columns file, kind (flap, crac, friction,
/// tear) and, if need be, l_r, l_c, width (m; of a panel, across its rulings), root_across and
/// root_along (of the beam equation: how it is held, models/sound/voices/bank.h), speed (m/s; of
/// friction), energy (J; of the event that is as loud as the sound at 1 m; default 1e-6) and peak
/// (Pa; pressure of the full scale; default 1). Files of several channels are averaged, those of
/// another sample rate than the first's resampled.
///
/// @param notes   added: what was averaged or resampled
/// @param inputs  added: every file that was read
/// @throws Error  naming file and line: no such folder or file, a name that leads out of the
///                folder, an unknown kind, a flap or crac without l_r and l_c, friction without
///                speed, numbers that are not 0 or more, sounds that are no WAV
///                (testbed/formats/wav_file.h)
SoundBank read_bank(const std::filesystem::path& folder, std::vector<std::string>& notes,
                    std::vector<std::filesystem::path>& inputs);

/// Writes a bank so that `read_bank` reads it: 24-bit WAV files, scaled to fit, and bank.csv. The
/// folder is made; files that are there are replaced.
void write_bank(const SoundBank& bank, const std::filesystem::path& folder);

}  // namespace geoprior::sound
