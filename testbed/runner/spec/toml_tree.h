#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// A TOML value that keeps where it was written when it is copied: the runner merges [quick], --set
/// and sweeps into one tree and still names the line of a mistake.
struct TomlNode {
  enum class Kind { boolean, integer, real, text, array, table };
  Kind kind = Kind::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double real = 0;
  std::string text;
  std::vector<std::string> keys;  ///< of a table, in the order of the file
  std::vector<TomlNode> items;    ///< of an array, or of a table beside `keys`
  std::string place;              ///< "file:line:column" of the key (of the value in an array)

  [[nodiscard]] const TomlNode* find(std::string_view key) const;
  [[nodiscard]] TomlNode* find(std::string_view key);
  /// Replaces or adds a member of a table.
  void set(const std::string& key, TomlNode value);
  void erase(std::string_view key);
  /// "a table", "an integer", … for messages.
  [[nodiscard]] std::string kind_name() const;
};

/// Throws Error "file:line:column: …" on a syntax error, a date or a time (no option has one).
TomlNode parse_toml_file(const std::filesystem::path& file);
TomlNode parse_toml_text(std::string_view text, const std::string& source);

/// A TOML value; what is no TOML value but a bare word (letters, digits, "_-./:+") is a text.
TomlNode parse_toml_value(const std::string& value, const std::string& source);

/// Parts of a dotted key; quoted parts may hold dots. Throws Error on an empty part.
std::vector<std::string> split_dotted_key(const std::string& key, const std::string& place);

/// Sets the member that the parts name below `root`, making tables on the way; a number names an
/// element of an array. Throws Error when the way leads through something else.
void set_at(TomlNode& root, const std::vector<std::string>& parts, const TomlNode& value);

/// The nearest of `names` by edit distance when it is near enough to be meant, else "".
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// "a, b, c; did you mean 'b'?": what an Error gives as allowed.
std::string allowed_names(std::string_view name, const std::vector<std::string>& names);

/// "file:line:column: key" of a member of a table, or of the table when it has none of that name.
std::string place_of(const TomlNode& table, std::string_view key);

}  // namespace geoprior
