#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/runner/option_values.h"

namespace geoprior {

class OptionLister;
extern template class OptionValues<OptionLister>;

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
class OptionLister final : public OptionValues<OptionLister> {
 public:
  [[nodiscard]] const std::vector<OptionRow>& rows() const { return rows_; }

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
  friend OptionValues<OptionLister>;
  template <class T>
  void visit_value(std::string_view key, T& x, const OptionInfo& info);
  void add(std::string_view key, std::string type, std::string default_value,
           const OptionInfo& info);
  void walk(const std::string& key, const std::function<void()>& inside);

  std::vector<OptionRow> rows_;
  std::string prefix_;
};

/// A Markdown table of the rows, for the documentation.
std::string markdown_table(const std::vector<OptionRow>& rows);

}  // namespace geoprior
