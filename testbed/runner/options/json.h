#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/options.h"

namespace geoprior {

/// Writes the options that `describe` walks as JSON, every option with its value, in the order of
/// `describe`; absent optionals are null.
class OptionJsonWriter final : public OptionVisitor {
 public:
  OptionJsonWriter();
  [[nodiscard]] const nlohmann::ordered_json& json() const { return root_; }

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
  nlohmann::ordered_json& member(std::string_view key);
  nlohmann::ordered_json walk(const std::function<void()>& inside);

  nlohmann::ordered_json root_;
  nlohmann::ordered_json* table_;
};

/// A JSON object as TOML text: plain members first, then tables and arrays of tables under their
/// headers; nulls are left out. The same object gives the same text.
std::string toml_text(const nlohmann::ordered_json& object);

/// A key of a TOML table, and a text, as TOML writes them: in quotes with escapes where need be.
/// The text is UTF-8.
std::string toml_key(const std::string& key);
std::string toml_string(const std::string& text);

}  // namespace geoprior
