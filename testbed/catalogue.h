#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace geoprior {

/// An experiment file of the clone, as `list` shows it.
struct CatalogueEntry {
  std::string id;
  std::string title;
  std::string figure;
  std::string topic;
  std::filesystem::path file;
};

/// The files experiments/<folder>/<name>.toml of the clone, sorted; files with a second dot in
/// their name (human.skeleton.toml) are inputs. An identifier is <folder>/<name>, or what the file
/// says (`id`).
std::vector<CatalogueEntry> catalogue();

/// The file of an identifier of the catalogue.
std::optional<std::filesystem::path> catalogued_file(const std::string& id);

}  // namespace geoprior
