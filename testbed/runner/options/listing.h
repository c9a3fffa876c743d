#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/options.h"

namespace geoprior {

/// One option as `geoprior describe` and the documentation show it.
struct OptionRow {
  std::string key;            ///< dotted; elements of a list as "joints[].to_deg"
  std::string type;           ///< "number", "integer", "boolean", "text", "file", "choice", …
  std::string default_value;  ///< as TOML; "" when absent, "required" when it must be given
  std::string range;          ///< "at least 0", or the names of a choice
  std::string unit;
  std::string doc;
  std::string when = {};       ///< "kind = disc | svg": there under these tags only; "" for always
  bool may_be_absent = false;  ///< a table that `key = false` switches off

  /// A text, whatever it names.
  [[nodiscard]] bool is_text() const;
  /// `doc`, preceded by `when` in brackets.
  [[nodiscard]] std::string meaning() const;
};

/// The options that `describe` walks, with the values they have as defaults: the members under
/// every tag of a tagged choice, those of tables that are absent, and those of one element of every
/// list. The struct behind `describe` is changed by that: hand in a copy.
///
/// Two choices of one table are varied one at a time, the other at its default: a key that needs
/// two tags other than the defaults at once is found when the second tag is itself selected by the
/// first.
std::vector<OptionRow> list_options(const std::function<void(OptionVisitor&)>& describe);

/// A Markdown table of the rows, for the documentation.
std::string markdown_table(const std::vector<OptionRow>& rows);

}  // namespace geoprior
