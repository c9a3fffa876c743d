#pragma once

#include <string>
#include <vector>

#include "core/options.h"

namespace geoprior {

/// One option as `geoprior describe` and the documentation show it.
struct OptionRow {
  std::string key;            ///< dotted; elements of a list as "joints[].to_deg"
  std::string type;           ///< "number", "integer", "boolean", "text", "choice", "table", …
  std::string default_value;  ///< as TOML; "" when absent, "required" when it must be given
  std::string range;          ///< "at least 0", or the names of a choice
  std::string unit;
  std::string doc;
};

/// Lists the options that `describe` walks, with the values they have as defaults. Lists without
/// elements are given one and tables that are absent are walked, so the struct is changed: hand in
/// a copy.
class OptionLister final : public OptionVisitor {
 public:
  [[nodiscard]] const std::vector<OptionRow>& rows() const { return rows_; }

  void value(std::string_view key, double& x, const OptionInfo& info) override;
  void value(std::string_view key, int& x, const OptionInfo& info) override;
  void value(std::string_view key, bool& x, const OptionInfo& info) override;
  void value(std::string_view key, std::string& x, const OptionInfo& info) override;
  void value(std::string_view key, std::vector<double>& x, const OptionInfo& info) override;
  void value(std::string_view key, std::vector<std::string>& x, const OptionInfo& info) override;
  void value(std::string_view key, std::optional<double>& x, const OptionInfo& info) override;
  void value(std::string_view key, std::optional<int>& x, const OptionInfo& info) override;
  void value(std::string_view key, std::optional<std::string>& x, const OptionInfo& info) override;
  void value(std::string_view key, std::array<double, 3>& x, const OptionInfo& info) override;
  void value(std::string_view key, std::array<int, 3>& x, const OptionInfo& info) override;
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const OptionInfo& info) override;
  void group(std::string_view key, const OptionInfo& info,
             const std::function<void()>& inside) override;
  void optional_group(std::string_view key, bool& present, const OptionInfo& info,
                      const std::function<void()>& inside) override;
  void list(std::string_view key, std::size_t count, const OptionInfo& info,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& inside) override;

 private:
  void add(std::string_view key, std::string type, std::string default_value,
           const OptionInfo& info);
  void walk(const std::string& key, const std::function<void()>& inside);

  std::vector<OptionRow> rows_;
  std::string prefix_;
};

/// A Markdown table of the rows, for the documentation.
std::string markdown_table(const std::vector<OptionRow>& rows);

}  // namespace geoprior
