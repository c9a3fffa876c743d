#include "testbed/formats/sequence/find.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/sequence/pvd.h"
#include "testbed/formats/text/lines.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostDigits = 9;  // fits an int
constexpr std::size_t kMostNames = 8;   // listed in a message

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "wave_%04d.ply" in pieces.
struct Pattern {
  std::string prefix, suffix;
  std::size_t width = 1;

  /// The number in a file name that matches.
  [[nodiscard]] std::optional<int> match(const std::string& name) const {
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) ||
        !name.ends_with(suffix)) {
      return std::nullopt;
    }
    const std::string digits =
        name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    if (!all_digits(digits) || digits.size() > kMostDigits || digits.size() < width) {
      return std::nullopt;
    }
    if (digits.size() > width && digits.front() == '0') return std::nullopt;
    return static_cast<int>(*whole_number(digits));
  }
};

Pattern parse_pattern(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto refuse = [&](const std::string& problem) {
    return Error(problem, path.string(), "one number in the file name: %04d, %d");
  };
  if (path.parent_path().string().find('%') != std::string::npos) {
    throw refuse("has a '%' in its folder");
  }
  const std::size_t begin = name.find('%');
  if (begin == std::string::npos || name.find('%', begin + 1) != std::string::npos) {
    throw refuse("has not one number");
  }
  const std::size_t end = name.find('d', begin);
  if (end == std::string::npos) throw refuse("has a '%' without 'd'");
  const std::string width = name.substr(begin + 1, end - begin - 1);
  Pattern pattern{name.substr(0, begin), name.substr(end + 1), 1};
  if (!width.empty()) {
    if (!all_digits(width) || width.front() != '0' || width.size() > 2) {
      throw refuse("has the number '%" + width + "d'");
    }
    pattern.width = std::max<std::size_t>(1, static_cast<std::size_t>(*whole_number(width)));
  }
  return pattern;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_regular_file(error)) names.push_back(it->path().filename().string());
  }
  if (error) throw Error("cannot be listed: " + error.message(), folder.string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kMostNames) text += ", …";
  return text;
}

FoundFiles in_order(std::map<int, fs::path> by_number) {
  FoundFiles found;
  for (auto& [number, file] : by_number) found.files.push_back({std::move(file), number, {}});
  return found;
}

/// Numbered meshes of a folder: stem and extension ("surface_", ".vtp") -> number -> file.
using Families = std::map<std::pair<std::string, std::string>, std::map<int, fs::path>>;

Families families_in(const fs::path& folder) {
  Families families;
  for (const std::string& name : names_in(folder)) {
    const fs::path path = folder / name;
    const std::string extension = path.extension().string(), stem = path.stem().string();
    if (!is_mesh_file_extension(extension)) continue;
    const std::size_t last = stem.find_last_not_of("0123456789");
    const std::string digits = stem.substr(last == std::string::npos ? 0 : last + 1);
    if (digits.empty() || digits.size() > kMostDigits) continue;
    const int number = static_cast<int>(*whole_number(digits));
    auto& family = families[{stem.substr(0, stem.size() - digits.size()), extension}];
    if (const auto [it, is_new] = family.emplace(number, path); !is_new) {
      throw Error("has the same number as " + it->second.filename().string(), path.string());
    }
  }
  return families;
}

bool is_of_part(const std::string& stem, const std::string& part) {
  return stem == part || stem == part + "_" || stem == part + "-" || stem == part + ".";
}

/// Gives the files of a folder the times of the collection beside it, when it names them all.
void take_times(FoundFiles& found, const fs::path& folder, const std::string& part) {
  const fs::path own = folder.has_filename() ? folder : folder.parent_path();
  const fs::path pvd = own.string() + ".pvd";
  if (!fs::is_regular_file(pvd)) return;
  std::map<fs::path, double> times;
  for (const PvdDataSet& entry : read_pvd(pvd)) {
    if (entry.name.empty() || entry.name == part || found.files.empty()) {
      times[fs::weakly_canonical(entry.file)] = entry.time;
    }
  }
  std::vector<double> of_files;
  for (const FoundFile& file : found.files) {
    const auto it = times.find(fs::weakly_canonical(file.file));
    if (it == times.end()) return;
    of_files.push_back(it->second);
  }
  for (std::size_t i = 0; i < of_files.size(); ++i) found.files[i].time = of_files[i];
  found.collection = pvd;
}

}  // namespace

FoundFiles find_pattern(const fs::path& path) {
  const Pattern pattern = parse_pattern(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!is_mesh_file_extension(path.extension().string())) {
    throw Error("has the extension '" + path.extension().string() + "'", path.string(),
                mesh_file_extensions());
  }
  if (!fs::is_directory(folder)) throw Error("is in no folder", path.string());
  const std::vector<std::string> names = names_in(folder);
  std::map<int, fs::path> by_number;
  for (const std::string& name : names) {
    if (const auto number = pattern.match(name)) by_number[*number] = folder / name;
  }
  if (by_number.empty()) {
    throw Error("matches no file", path.string(),
                names.empty() ? "the folder has none" : "the folder has " + listed(names));
  }
  return in_order(std::move(by_number));
}

bool matches_any(const fs::path& path) {
  const Pattern pattern = parse_pattern(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) return false;
  const std::vector<std::string> names = names_in(folder);
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return pattern.match(name).has_value(); });
}

FoundFiles find_in_folder(const fs::path& folder, const std::string& part) {
  Families families = families_in(folder);
  std::vector<std::string> names;
  std::vector<std::map<int, fs::path>*> of_part;
  for (auto& [key, files] : families) {
    names.push_back(key.first + "%04d" + key.second);
    if (is_of_part(key.first, part)) of_part.push_back(&files);
  }
  if (families.empty()) {
    throw Error("holds no numbered meshes", folder.string(),
                "name_0000" + std::string(" with ") + mesh_file_extensions());
  }
  if (of_part.empty() && families.size() == 1) of_part.push_back(&families.begin()->second);
  if (of_part.size() != 1) {
    throw Error(of_part.empty() ? "holds several sequences, none of the part '" + part + "'"
                                : "holds several sequences of the part '" + part + "'",
                folder.string(), "name one: " + listed(names));
  }
  FoundFiles found = in_order(std::move(*of_part.front()));
  take_times(found, folder, part);
  return found;
}

FoundFiles find_in_pvd(const fs::path& file, const std::string& part) {
  std::vector<PvdDataSet> sets = read_pvd(file);
  const bool named = std::any_of(sets.begin(), sets.end(),
                                 [&](const PvdDataSet& set) { return set.name == part; });
  if (named) std::erase_if(sets, [&](const PvdDataSet& set) { return set.name != part; });
  std::stable_sort(sets.begin(), sets.end(),
                   [](const PvdDataSet& a, const PvdDataSet& b) { return a.time < b.time; });
  FoundFiles found;
  found.collection = file;
  std::vector<std::string> missing;
  for (int i = 0; i < std::ssize(sets); ++i) {
    if (i > 0 && sets[i].time == sets[i - 1].time) {
      throw Error("has two files for the time " + std::to_string(sets[i].time) +
                      " s: " + sets[i - 1].file.filename().string() + ", " +
                      sets[i].file.filename().string(),
                  file.string(), "one a time, or several that name the part '" + part + "'");
    }
    if (!is_mesh_file_extension(sets[i].file.extension().string())) {
      throw Error("has the extension '" + sets[i].file.extension().string() + "'",
                  sets[i].file.string(), mesh_file_extensions());
    }
    if (fs::is_regular_file(sets[i].file)) {
      found.files.push_back({sets[i].file, i, sets[i].time});
    } else {
      missing.push_back(sets[i].file.filename().string());
    }
  }
  if (found.files.empty()) {
    throw Error(sets.empty() ? "names no file" : "none of its files is there: " + listed(missing),
                file.string());
  }
  if (!missing.empty()) {
    found.warnings.push_back(file.filename().string() + ": " + std::to_string(missing.size()) +
                             " of " + std::to_string(sets.size()) +
                             " files are missing: " + listed(missing));
  }
  return found;
}

}  // namespace geoprior
