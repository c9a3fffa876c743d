#include "experiments/runner/option_listing.h"

#include "experiments/runner/number_text.h"
#include "experiments/runner/option_toml.h"

namespace geoprior {
namespace {

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

template <class Items, class Text>
std::string array_text(const Items& items, Text text) {
  std::string joined;
  for (const auto& item : items) joined += (joined.empty() ? "" : ", ") + text(item);
  return "[" + joined + "]";
}

}  // namespace

void OptionLister::add(std::string_view key, std::string type, std::string default_value,
                       const OptionInfo& info) {
  OptionInfo without_unit = info;
  without_unit.unit = "";
  rows_.push_back({prefix_ + std::string(key), std::move(type),
                   info.required ? "required" : std::move(default_value), range_text(without_unit),
                   std::string(info.unit), std::string(info.doc)});
}

void OptionLister::walk(const std::string& key, const std::function<void()>& inside) {
  const std::string outer = prefix_;
  prefix_ += key + ".";
  inside();
  prefix_ = outer;
}

void OptionLister::value(std::string_view key, double& x, const OptionInfo& info) {
  add(key, "number", number_text(x), info);
}
void OptionLister::value(std::string_view key, int& x, const OptionInfo& info) {
  add(key, "integer", std::to_string(x), info);
}
void OptionLister::value(std::string_view key, bool& x, const OptionInfo& info) {
  add(key, "boolean", x ? "true" : "false", info);
}
void OptionLister::value(std::string_view key, std::string& x, const OptionInfo& info) {
  add(key, "text", in_quotes(x), info);
}
void OptionLister::value(std::string_view key, std::vector<double>& x, const OptionInfo& info) {
  add(key, "numbers", array_text(x, number_text), info);
}
void OptionLister::value(std::string_view key, std::vector<std::string>& x,
                         const OptionInfo& info) {
  add(key, "texts", array_text(x, in_quotes), info);
}
void OptionLister::value(std::string_view key, std::optional<double>& x, const OptionInfo& info) {
  add(key, "number", x ? number_text(*x) : "", info);
}
void OptionLister::value(std::string_view key, std::optional<int>& x, const OptionInfo& info) {
  add(key, "integer", x ? std::to_string(*x) : "", info);
}
void OptionLister::value(std::string_view key, std::optional<std::string>& x,
                         const OptionInfo& info) {
  add(key, "text", x ? in_quotes(*x) : "", info);
}
void OptionLister::value(std::string_view key, std::array<double, 3>& x, const OptionInfo& info) {
  add(key, "3 numbers", array_text(x, number_text), info);
}
void OptionLister::value(std::string_view key, std::array<int, 3>& x, const OptionInfo& info) {
  add(key, "3 integers", array_text(x, [](int i) { return std::to_string(i); }), info);
}

void OptionLister::choice(std::string_view key, int& index, std::span<const std::string_view> names,
                          const OptionInfo& info) {
  add(key, "choice", in_quotes(std::string(names[static_cast<std::size_t>(index)])), info);
  std::string range;
  for (const std::string_view name : names)
    range += (range.empty() ? "" : " | ") + std::string(name);
  rows_.back().range = range;
}

void OptionLister::group(std::string_view key, const OptionInfo& info,
                         const std::function<void()>& inside) {
  add(key, "table", "", info);
  walk(std::string(key), inside);
}

void OptionLister::optional_group(std::string_view key, bool& present, const OptionInfo& info,
                                  const std::function<void()>& inside) {
  add(key, "table", present ? "" : "false", info);
  present = true;
  walk(std::string(key), inside);
}

void OptionLister::list(std::string_view key, std::size_t count, const OptionInfo& info,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(std::size_t)>& inside) {
  add(key, "tables", count == 0 ? "[]" : std::to_string(count) + " elements", info);
  if (count == 0) resize(1);
  walk(std::string(key) + "[]", [&] { inside(0); });
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
            cell(row.range) + " | " + cell(row.unit) + " | " + cell(row.doc) + " |\n";
  }
  return text;
}

}  // namespace geoprior
