#include "experiments/sound/scene/bank_cache.h"

#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/state_bytes.h"
#include "experiments/paper/scene/options.h"
#include "experiments/sound/scene/bank_files.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/home.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/process/build_info.h"

namespace geoprior::sound {
namespace {

namespace fs = std::filesystem;

/// Of all that a generated bank depends on, the program included.
std::string name_of(const PaperMaterial& material, const BankOptions& o, std::uint64_t seed) {
  const BuildInfo& build = build_info();
  StateWriter out;
  for (const std::string& text : {build.git_commit, build.git_difference, build.compiler,
                                  build.build_type, build.flags, build.instruction_set}) {
    out.text(text);
  }
  for (const double x :
       {material.thickness, material.young_modulus, material.poisson_ratio, material.area_density,
        o.damping, o.flap_bow, o.crac_bow, o.crackles, o.highest}) {
    out.number(x);
  }
  for (const int n : {o.sizes, o.variants, o.most_modes}) out.number(n);
  out.number(seed);
  return sha256(out.take()).substr(0, 16) + ".bank";
}

State bytes_of(const SoundBank& bank) {
  StateWriter out;
  out.number(bank.sample_rate);
  out.number(bank.sounds.size());
  for (const BankSound& sound : bank.sounds) {
    out.number(sound.kind);
    for (const BankNumber& number : kBankNumbers) out.number(sound.*number.value);
    out.matrix(sound.samples);
  }
  out.number(checksum(bank));
  return out.take();
}

/// Nothing when the file is not there or not what was written.
std::optional<SoundBank> read(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  try {
    const std::string text = read_whole_file(file);
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    const State bytes(first, first + text.size());
    StateReader in(bytes);
    SoundBank bank;
    bank.sample_rate = in.number<int>();
    bank.sounds.resize(in.count(sizeof(SoundKind) + kBankNumbers.size() * sizeof(double)));
    for (BankSound& sound : bank.sounds) {
      sound.kind = in.number<SoundKind>();
      for (const BankNumber& number : kBankNumbers) sound.*number.value = in.number<double>();
      in.matrix(sound.samples);
    }
    const bool same = in.number<std::uint64_t>() == checksum(bank);
    in.require_end();
    if (!same) return {};
    return bank;
  } catch (const Error&) {
    return {};
  }
}

/// Options of `geoprior bank`.
struct BankCommandOptions {
  int seed = 1;
  PaperMaterial material;
  BankOptions bank;
};

void describe(OptionVisitor& v, BankCommandOptions& o) {
  v.value("seed", o.seed, {.doc = "seed of the bank, as `seed` of an experiment", .min = 0});
  paper::describe_plate(v, o.material);
  describe(v, o.bank);
}

CommandText write_generated(const std::string& folder, const BankCommandOptions& options) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error)) {
    throw Error("is there and not empty", folder, "a folder to be made, or an empty one");
  }
  const SoundBank bank =
      generate_bank(options.material, options.bank, static_cast<std::uint64_t>(options.seed));
  write_bank(bank, folder);
  return {std::to_string(bank.sounds.size()) + " sounds in " + folder + "\n", {}};
}

}  // namespace

fs::path bank_folder() { return writable_home() / "data" / "banks"; }

SoundBank cached_bank(const PaperMaterial& material, const BankOptions& options, std::uint64_t seed,
                      const fs::path& folder) {
  const fs::path file = folder / name_of(material, options, seed);
  if (auto bank = read(file)) return *std::move(bank);
  SoundBank bank = generate_bank(material, options, seed);
  try {
    make_folders(folder);
    write_file_atomically(file, std::span<const std::byte>(bytes_of(bank)));
  } catch (const Error&) {
    // A clone that cannot be written, a full disk: the bank is made each time.
  }
  return bank;
}

TopicCommand bank_command() {
  return topic_command<BankCommandOptions>("bank", "write a generated bank of paper's sounds",
                                           "folder", "made, or empty", write_generated);
}

}  // namespace geoprior::sound
