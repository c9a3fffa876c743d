#include "experiments/sound/scene/bank_files.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/text/csv_table.h"
#include "testbed/formats/wav_file.h"

namespace geoprior::sound {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "bank.csv";
constexpr const char* kPeak = "peak";  // column: what the largest sample stands for

SoundKind kind_of(const std::string& text, const std::string& place) {
  const auto found = std::find(kSoundKinds.begin(), kSoundKinds.end(), text);
  if (found == kSoundKinds.end()) {
    throw Error("'" + text + "' is no kind of sound", place, "flap, crac, friction, tear");
  }
  return static_cast<SoundKind>(found - kSoundKinds.begin());
}

/// A file of the folder, by the name that the list gives it.
fs::path file_in(const fs::path& folder, const std::string& name, const std::string& place) {
  const fs::path given(name);
  const bool leads_out =
      given.is_absolute() ||
      std::any_of(given.begin(), given.end(), [](const fs::path& part) { return part == ".."; });
  if (name.empty() || leads_out) {
    throw Error("names the file '" + name + "'", place, "a file in the bank's folder");
  }
  fs::path file = folder / given;
  if (!fs::is_regular_file(file)) {
    throw Error("names the file '" + name + "', which is not there", place,
                "a WAV file in " + folder.string());
  }
  return file;
}

/// Of a row; what its kind needs must be there.
BankSound descriptors_of(const CsvTable& table, const CsvTable::Row& row) {
  BankSound sound;
  sound.kind = kind_of(*table.text(row, "kind"), row.place);
  const auto number = [&](const char* column, double& to, bool needed) {
    const std::optional<std::string> cell = table.text(row, column);
    if (!cell || cell->empty()) {
      if (needed) throw Error("has no " + std::string(column), row.place, "a number");
      return;
    }
    const std::optional<double> x = table.number(row, column);
    if (*x < 0) throw Error(std::string(column) + " is negative", row.place, "0 or more");
    to = *x;
  };
  const bool snap = sound.kind == SoundKind::flap || sound.kind == SoundKind::crac;
  for (const BankNumber& of : kBankNumbers) {
    const std::string_view name = of.name;
    const bool needed = name == "speed" ? sound.kind == SoundKind::friction
                                        : snap && (name == "l_r" || name == "l_c");
    number(of.name, sound.*of.value, needed);
  }
  if (!(sound.energy > 0)) throw Error("energy is 0", row.place, "more than 0");
  return sound;
}

/// One channel at the rate of the bank.
Eigen::VectorXf mono(Sound sound, int rate, const std::string& name,
                     std::vector<std::string>& notes) {
  if (sound.samples.cols() > 1) {
    notes.push_back(name + ": the mean of its " + std::to_string(sound.samples.cols()) +
                    " channels is taken");
    sound.samples = sound.samples.rowwise().mean().eval();
  }
  if (sound.sample_rate != rate) {
    notes.push_back(name + ": resampled from " + std::to_string(sound.sample_rate) + " Hz to " +
                    std::to_string(rate) + " Hz, the rate of the bank's first file");
    sound = resampled(sound, rate);
  }
  return sound.samples.col(0).cast<float>();
}

}  // namespace

SoundBank read_bank(const fs::path& folder, std::vector<std::string>& notes,
                    std::vector<fs::path>& inputs) {
  if (!fs::is_directory(folder)) throw Error("is no folder", folder.string());
  const fs::path list = folder / kList;
  std::vector<std::string_view> optional{kPeak};
  for (const BankNumber& number : kBankNumbers) optional.emplace_back(number.name);
  const CsvTable table(list, {"file", "kind"}, optional);
  inputs.push_back(list);
  SoundBank bank;
  for (const CsvTable::Row& row : table.rows()) {
    BankSound sound = descriptors_of(table, row);
    const fs::path file = file_in(folder, *table.text(row, "file"), row.place);
    inputs.push_back(file);
    Sound read = read_wav(file, notes);
    if (bank.sounds.empty()) bank.sample_rate = read.sample_rate;
    sound.samples = mono(std::move(read), bank.sample_rate, file.string(), notes);
    sound.samples *= static_cast<float>(table.number(row, kPeak).value_or(1));
    bank.sounds.push_back(std::move(sound));
  }
  require_valid(bank, list.string());
  return bank;
}

void write_bank(const SoundBank& bank, const fs::path& folder) {
  make_folders(folder);
  std::string list = "file,kind";
  for (const BankNumber& number : kBankNumbers) list += std::string(",") + number.name;
  list += std::string(",") + kPeak + "\n";
  for (std::size_t i = 0; i < bank.sounds.size(); ++i) {
    const BankSound& sound = bank.sounds[i];
    const double peak = std::max(1e-30f, sound.samples.cwiseAbs().maxCoeff());
    const std::string kind(kSoundKinds[static_cast<std::size_t>(sound.kind)]);
    char name[40];
    std::snprintf(name, sizeof name, "%04zu-%s.wav", i, kind.c_str());
    Sound file{bank.sample_rate, sound.samples.cast<double>() / peak};
    write_file_atomically(folder / name, wav_bytes(file));
    list += std::string(name) + "," + kind;
    const auto append = [&list](double x) {
      char text[32];
      std::snprintf(text, sizeof text, ",%.17g", x);
      list += text;
    };
    for (const BankNumber& number : kBankNumbers) append(sound.*number.value);
    append(peak);
    list += "\n";
  }
  write_file_atomically(folder / kList, list);
}

}  // namespace geoprior::sound
