#include "testbed/formats/sequence/find.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
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
    std::string_view digits = name;
    digits = digits.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    const bool negative = digits.starts_with('-');
    if (negative) digits.remove_prefix(1);
    // C counts the sign among the digits, others do not.
    const std::size_t fewest = negative && width > 1 ? width - 1 : width;
    if (!all_digits(digits) || digits.size() > kMostDigits || digits.size() < fewest) {
      return std::nullopt;
    }
    if (digits.size() > width && digits.front() == '0') return std::nullopt;
    const int number = static_cast<int>(*whole_number(digits));
    return negative ? -number : number;
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

/// Whether a minus before digits is their sign ("a_-2") and no hyphen ("a-2").
bool is_sign(std::string_view before) {
  if (before == "-") return true;
  if (!before.ends_with('-')) return false;
  const char c = before[before.size() - 2];
  return c == '_' || c == '.' || c == ' ';
}

Families families_in(const fs::path& folder) {
  Families families;
  for (const std::string& name : names_in(folder)) {
    const fs::path path = folder / name;
    const std::string extension = path.extension().string(), stem = path.stem().string();
    if (!is_mesh_file_extension(extension)) continue;
    const std::size_t last = stem.find_last_not_of("0123456789");
    const std::string digits = stem.substr(last == std::string::npos ? 0 : last + 1);
    if (digits.empty() || digits.size() > kMostDigits) continue;
    int number = static_cast<int>(*whole_number(digits));
    std::string before = stem.substr(0, stem.size() - digits.size());
    if (is_sign(before)) {
      number = -number;
      before.pop_back();
    }
    auto& family = families[{before, extension}];
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

void require_mesh(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (is_mesh_file_extension(extension)) return;
  throw Error("has the extension '" + extension + "'", file.string(), mesh_file_extensions());
}

/// Of two files of one time in a collection.
void require_other_part(const PvdDataSet& a, const PvdDataSet& b, const fs::path& file,
                        const std::string& part) {
  if (a.part != b.part) return;
  throw Error("has two files for the time " + std::to_string(a.time) +
                  " s: " + a.file.filename().string() + ", " + b.file.filename().string(),
              file.string(),
              "one a time, several with numbers of their own (part=\"0\", \"1\", …), or several of "
              "which some are named '" +
                  part + "'");
}

}  // namespace

FoundFiles find_pattern(const fs::path& path) {
  (void)parse_pattern(path);
  require_mesh(path);
  return find_numbered(path);
}

FoundFiles find_numbered(const fs::path& path) {
  const Pattern pattern = parse_pattern(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) throw Error("is in no folder", path.string());
  const std::vector<std::string> names = names_in(folder);
  std::map<int, fs::path> by_number;
  for (const std::string& name : names) {
    const auto number = pattern.match(name);
    if (!number) continue;
    if (const auto [it, is_new] = by_number.emplace(*number, folder / name); !is_new) {
      throw Error("has the same number as " + it->second.filename().string(),
                  (folder / name).string());
    }
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
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return false;
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

FoundFiles find_in_collection(const fs::path& file, const std::string& part) {
  std::vector<PvdDataSet> sets = file.extension() == ".series" ? read_series(file) : read_pvd(file);
  const bool named = std::any_of(sets.begin(), sets.end(),
                                 [&](const PvdDataSet& set) { return set.name == part; });
  if (named) std::erase_if(sets, [&](const PvdDataSet& set) { return set.name != part; });
  std::stable_sort(sets.begin(), sets.end(), [](const PvdDataSet& a, const PvdDataSet& b) {
    return std::pair(a.time, a.part) < std::pair(b.time, b.part);
  });
  FoundFiles found;
  found.collection = file;
  std::vector<std::string> missing;
  bool lacks_a_part = false, joins = false;
  int number = 0;
  for (auto set = sets.begin(); set != sets.end(); ++number) {
    const auto end =
        std::find_if(set, sets.end(), [&](const PvdDataSet& s) { return s.time != set->time; });
    FoundFile frame{set->file, number, set->time};
    const std::size_t missing_before = missing.size();
    for (auto of = set; of != end; ++of) {
      if (of != set) {
        require_other_part(*(of - 1), *of, file, part);
        frame.further.push_back(of->file);
      }
      require_mesh(of->file);
      std::error_code unknown;
      if (!fs::is_regular_file(of->file, unknown)) missing.push_back(of->file.filename().string());
    }
    if (missing.size() == missing_before) found.files.push_back(std::move(frame));
    joins = joins || end - set > 1;
    lacks_a_part = lacks_a_part || (missing.size() > missing_before && end - set > 1);
    set = end;
  }
  if (found.files.empty()) {
    throw Error(sets.empty() ? "names no file" : "none of its files is there: " + listed(missing),
                file.string());
  }
  if (joins) {
    found.warnings.push_back(file.filename().string() +
                             ": files of one time are parts of one frame, and joined");
  }
  if (!missing.empty()) {
    found.warnings.push_back(file.filename().string() + ": " + std::to_string(missing.size()) +
                             " of " + std::to_string(sets.size()) +
                             " files are missing: " + listed(missing) +
                             (lacks_a_part ? "; frames that lack a part are left out" : ""));
  }
  return found;
}

}  // namespace geoprior
