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
  nlohmann::ordered_json& member(std::string_view key);
  template <class T>
  void optional_member(std::string_view key, const std::optional<T>& x);
  nlohmann::ordered_json walk(const std::function<void()>& inside);

  nlohmann::ordered_json root_;
  nlohmann::ordered_json* table_;
};

/// A JSON object as TOML text: plain members first, then tables and arrays of tables under their
/// headers; nulls are left out. The same object gives the same text.
std::string toml_text(const nlohmann::ordered_json& object);

}  // namespace geoprior
