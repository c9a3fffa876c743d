#include "testbed/catalogue.h"

#include <algorithm>

#include "testbed/formats/folders.h"
#include "testbed/home.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

std::string text_of(const TomlNode& root, const char* key) {
  const TomlNode* node = root.find(key);
  return node == nullptr ? std::string() : node->text;
}

}  // namespace

std::vector<CatalogueEntry> catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const fs::path& folder : sorted_entries(geoprior_home() / "experiments")) {
    if (!fs::is_directory(folder)) continue;
    for (const fs::path& file : sorted_entries(folder)) {
      const bool experiment = file.extension() == ".toml" && !file.stem().has_extension();
      if (!experiment) continue;
      const TomlNode root = parse_toml_file(file);
      std::string id = text_of(root, "id");
      if (id.empty()) id = folder.filename().string() + "/" + file.stem().string();
      entries.push_back(
          {id, text_of(root, "title"), text_of(root, "figure"), text_of(root, "topic"), file});
    }
  }
  return entries;
}

std::optional<fs::path> catalogued_file(const std::string& id) {
  const fs::path placed = geoprior_home() / "experiments" / (id + ".toml");
  if (fs::is_regular_file(placed)) return placed;
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.id == id) return entry.file;
  }
  return std::nullopt;
}

}  // namespace geoprior
