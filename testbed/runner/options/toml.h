#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// Reads a TOML table into the options that `describe` walks.
///
/// Absent keys keep their default. Unknown keys, wrong types, NaN, infinities and values out of
/// range throw Error "file:line:column: key …: problem (allowed: …)". A table that may be absent
/// (`optional_group`) may also be switched off with `key = false`.
class OptionTomlReader final : public OptionVisitor {
 public:
  /// @param table  must outlive the reader
  /// @param path   dotted key of the table, "" at the top: for messages
  OptionTomlReader(const TomlNode& table, std::string path);
  /// Throws on keys that nothing has asked for: call it after `describe`.
  void finish() const;

  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const OptionInfo& info) override;
  void optional_choice(std::string_view key, std::optional<int>& index,
                       std::span<const std::string_view> names, const OptionInfo& info) override;
  void group(std::string_view key, const OptionInfo& info,
             const std::function<void()>& inside) override;
  void optional_group(std::string_view key, bool& present, const OptionInfo& info,
                      const std::function<void()>& inside) override;
  void list(std::string_view key, std::size_t count, const OptionInfo& info,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& inside) override;

 private:
  void visit_value(std::string_view key, const OptionReference& x, const OptionInfo& info) override;
  struct Level {
    const TomlNode* table;
    std::string path;
    std::vector<std::string> known;
  };

  const TomlNode* take(std::string_view key, const OptionInfo& info);
  [[nodiscard]] std::string where(const TomlNode& node, std::string_view key) const;
  [[nodiscard]] std::string path_of(std::string_view key) const;
  void walk(const TomlNode& table, std::string path, const std::function<void()>& inside);
  template <class T>
  T read(const TomlNode& node, std::string_view key, const OptionInfo& info) const;
  double number(const TomlNode& node, std::string_view key, const OptionInfo& info) const;
  int integer(const TomlNode& node, std::string_view key, const OptionInfo& info) const;
  const std::string& text(const TomlNode& node, std::string_view key, const OptionInfo& info) const;
  const TomlNode& array(const TomlNode& node, std::string_view key, std::string_view of,
                        std::optional<std::size_t> size = {}) const;
  static void require_all_known(const Level& level);

  std::vector<Level> levels_;
};

/// Reads `table` into `options` (a struct with `describe`) and refuses keys that it does not name.
template <class Options>
void read_options(const TomlNode& table, const std::string& path, Options& options) {
  OptionTomlReader reader(table, path);
  describe(reader, options);
  reader.finish();
}

/// "at least 0", "between 0 and 1", … with the unit; "" for any value.
std::string range_text(const OptionInfo& info);

}  // namespace geoprior
