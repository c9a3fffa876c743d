#include "testbed/runner/options/listing.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "testbed/joined.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/toml.h"

namespace geoprior {
namespace {

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

/// Type and default of an option as they are shown.
struct Shown {
  std::string type;
  std::string value;
};

Shown shown(double x) { return {"number", number_text(x)}; }
Shown shown(int x) { return {"integer", std::to_string(x)}; }
Shown shown(bool x) { return {"boolean", x ? "true" : "false"}; }
Shown shown(const std::string& x) { return {"text", in_quotes(x)}; }

template <class T>
Shown shown(const std::optional<T>& x) {
  return {shown(T{}).type, x ? shown(*x).value : ""};
}

template <class Items>
std::string array_text(const Items& items) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(shown(item).value);
  return "[" + joined(texts) + "]";
}

template <class T>
Shown shown(const std::vector<T>& x) {
  return {shown(T{}).type + "s", array_text(x)};
}

template <class T>
Shown shown(const std::array<T, 3>& x) {
  return {"3 " + shown(T{}).type + "s", array_text(x)};
}

/// Types of a text, by what it names.
constexpr std::array<std::string_view, 4> kTexts{"text", "file", "folder", "file or folder"};

std::string type_of(std::string type, Named named) {
  const bool is_text = type == "text" || type == "texts";
  if (!is_text || named == Named::nothing) return type;
  return std::string(kTexts[static_cast<std::size_t>(named)]) + (type == "texts" ? "s" : "");
}

/// Values that choices are made to have, by key.
using Forced = std::map<std::string, int>;

/// A choice that may select other members, and those that must be made for it to be there.
struct Tag {
  std::string key;
  std::vector<std::string> names;
  Forced context;
};

/// What one walk of a table met.
struct Walked {
  std::vector<OptionRow> rows;
  std::vector<Tag> tags;
};

const OptionRow* find_row(const std::vector<OptionRow>& rows, const std::string& key) {
  const auto at =
      std::find_if(rows.begin(), rows.end(), [&](const OptionRow& row) { return row.key == key; });
  return at == rows.end() ? nullptr : &*at;
}

/// Puts the rows that `all` lacks before the one that follows them in `more`.
void insert_new(std::vector<OptionRow>& all, const std::vector<OptionRow>& more) {
  for (std::size_t i = more.size(); i-- > 0;) {
    if (find_row(all, more[i].key) != nullptr) continue;
    const OptionRow* next = i + 1 < more.size() ? find_row(all, more[i + 1].key) : nullptr;
    all.insert(next == nullptr ? all.end() : all.begin() + (next - all.data()), more[i]);
  }
}

class OptionLister final : public OptionVisitor {
 public:
  /// Walks a table once for every tag of its choices.
  std::vector<OptionRow> walk(const std::string& prefix, const std::function<void()>& inside);

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
  void visit_value(std::string_view key, const OptionReference& x,
                   const OptionInfo& info) override {
    const Shown as = std::visit([](const auto* value) { return shown(*value); }, x);
    add(key, type_of(as.type, info.named), as.value, info);
  }
  Walked walk_once(const std::string& prefix, Forced forced, const std::function<void()>& inside);
  void walk_tags(const std::string& prefix, std::size_t tag, Walked& all,
                 const std::function<void()>& inside);
  void add(std::string_view key, std::string type, std::string default_value,
           const OptionInfo& info);
  void add_inside(const std::string& key, const std::function<void()>& inside);

  Walked walked_;
  std::string prefix_;
  Forced forced_;
  Forced usual_;  ///< what a choice was when it was first met
};

Walked OptionLister::walk_once(const std::string& prefix, Forced forced,
                               const std::function<void()>& inside) {
  Walked outer = std::exchange(walked_, {});
  std::string outer_prefix = std::exchange(prefix_, prefix);
  Forced outer_forced = std::exchange(forced_, std::move(forced));
  inside();
  prefix_ = std::move(outer_prefix);
  forced_ = std::move(outer_forced);
  return std::exchange(walked_, std::move(outer));
}

/// Adds the rows that only some tags select, and says so in each.
void OptionLister::walk_tags(const std::string& prefix, std::size_t tag, Walked& all,
                             const std::function<void()>& inside) {
  const Tag of = all.tags[tag];
  std::map<std::string, std::vector<std::string>> names_with;
  for (int i = 0; i < std::ssize(of.names); ++i) {
    Forced forced = of.context;
    forced[of.key] = i;
    Walked one = walk_once(prefix, forced, inside);
    for (const OptionRow& row : one.rows) names_with[row.key].push_back(of.names[i]);
    insert_new(all.rows, one.rows);
    for (Tag& met : one.tags) {
      const bool known = std::any_of(all.tags.begin(), all.tags.end(),
                                     [&](const Tag& other) { return other.key == met.key; });
      if (!known) all.tags.push_back({std::move(met.key), std::move(met.names), forced});
    }
  }
  std::string of_tag = find_row(all.rows, of.key)->when;
  if (!of_tag.empty()) of_tag += ", ";
  for (OptionRow& row : all.rows) {
    const auto names = names_with.find(row.key);
    if (names == names_with.end() || names->second.size() == of.names.size()) continue;
    const std::string when =
        of_tag + of.key.substr(prefix.size()) + " = " + joined(names->second, " | ");
    row.when = row.when.empty() || when.starts_with(row.when) ? when : when + ", " + row.when;
  }
}

std::vector<OptionRow> OptionLister::walk(const std::string& prefix,
                                          const std::function<void()>& inside) {
  Walked all = walk_once(prefix, {}, inside);
  for (std::size_t tag = 0; tag < all.tags.size(); ++tag) walk_tags(prefix, tag, all, inside);
  // Leaves the choices as they were.
  if (!all.tags.empty()) walk_once(prefix, {}, inside);
  return all.rows;
}

void OptionLister::add(std::string_view key, std::string type, std::string default_value,
                       const OptionInfo& info) {
  OptionInfo without_unit = info;
  without_unit.unit = "";
  walked_.rows.push_back({prefix_ + std::string(key), std::move(type),
                          info.required ? "required" : std::move(default_value),
                          range_text(without_unit), std::string(info.unit), std::string(info.doc)});
}

void OptionLister::add_inside(const std::string& key, const std::function<void()>& inside) {
  for (OptionRow& row : walk(prefix_ + key + ".", inside)) walked_.rows.push_back(std::move(row));
}

void OptionLister::choice(std::string_view key, int& index, std::span<const std::string_view> names,
                          const OptionInfo& info) {
  const std::string full = prefix_ + std::string(key);
  const int usual = usual_.try_emplace(full, index).first->second;
  const auto forced = forced_.find(full);
  index = forced == forced_.end() ? usual : forced->second;
  add(key, "choice", in_quotes(std::string(names[usual])), info);
  Tag tag{full, {names.begin(), names.end()}, {}};
  walked_.rows.back().range = joined(tag.names, " | ");
  walked_.tags.push_back(std::move(tag));
}

void OptionLister::optional_choice(std::string_view key, std::optional<int>& index,
                                   std::span<const std::string_view> names,
                                   const OptionInfo& info) {
  add(key, "choice", index ? in_quotes(std::string(names[*index])) : "", info);
  walked_.rows.back().range = joined(names, " | ");
}

void OptionLister::group(std::string_view key, const OptionInfo& info,
                         const std::function<void()>& inside) {
  add(key, "table", "", info);
  add_inside(std::string(key), inside);
}

void OptionLister::optional_group(std::string_view key, bool& present, const OptionInfo& info,
                                  const std::function<void()>& inside) {
  add(key, "table", present ? "" : "false", info);
  walked_.rows.back().may_be_absent = true;
  present = true;
  add_inside(std::string(key), inside);
}

void OptionLister::list(std::string_view key, std::size_t count, const OptionInfo& info,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(std::size_t)>& inside) {
  add(key, "tables", count == 0 ? "[]" : std::to_string(count) + " elements", info);
  if (count == 0) resize(1);
  add_inside(std::string(key) + "[]", [&] { inside(0); });
}

}  // namespace

bool OptionRow::is_text() const {
  return std::find(kTexts.begin(), kTexts.end(), type) != kTexts.end();
}

std::string OptionRow::meaning() const { return when.empty() ? doc : "[" + when + "] " + doc; }

std::vector<OptionRow> list_options(const std::function<void(OptionVisitor&)>& describe) {
  OptionLister lister;
  return lister.walk("", [&] { describe(lister); });
}

std::string markdown_table(const std::vector<OptionRow>& rows) {
  std::string text =
      "| key | type | default | range | unit | meaning |\n|---|---|---|---|---|---|\n";
  const auto cell = [](const std::string& content) {
    std::string escaped;
    for (const char c : content) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
  };
  for (const OptionRow& row : rows) {
    text += "| `" + cell(row.key) + "` | " + row.type + " | " +
            (row.default_value.empty() ? "" : "`" + cell(row.default_value) + "`") + " | " +
            cell(row.range) + " | " + cell(row.unit) + " | " + cell(row.meaning()) + " |\n";
  }
  return text;
}

}  // namespace geoprior
