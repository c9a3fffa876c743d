#pragma once

#include <cstdint>
#include <filesystem>

#include "models/sound/voices/bank.h"
#include "testbed/topic.h"

namespace geoprior::sound {

/// What `generate_bank` makes, read from `folder` where this very build has made it before, and
/// left there else. A file whose bank has another checksum than the one behind it is made anew; a
/// folder that cannot be written is no error.
SoundBank cached_bank(const PaperMaterial& material, const BankOptions& options, std::uint64_t seed,
                      const std::filesystem::path& folder);

/// Where banks are kept: data/banks of the clone.
std::filesystem::path bank_folder();

/// `geoprior bank <folder>`: writes a generated bank as WAV files and bank.csv, to be changed, and
/// used as a user's own.
TopicCommand bank_command();

}  // namespace geoprior::sound
