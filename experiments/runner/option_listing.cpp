#include "experiments/runner/option_listing.h"

#include "experiments/runner/number_text.h"
#include "experiments/runner/option_toml.h"
#include "experiments/runner/option_values_definition.h"

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
  std::string joined;
  for (const auto& item : items) joined += (joined.empty() ? "" : ", ") + shown(item).value;
  return "[" + joined + "]";
}

template <class T>
Shown shown(const std::vector<T>& x) {
  return {shown(T{}).type + "s", array_text(x)};
}

template <class T>
Shown shown(const std::array<T, 3>& x) {
  return {"3 " + shown(T{}).type + "s", array_text(x)};
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

template <class T>
void OptionLister::visit_value(std::string_view key, T& x, const OptionInfo& info) {
  const Shown as = shown(x);
  add(key, as.type, as.value, info);
}

template class OptionValues<OptionLister>;

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
