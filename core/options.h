#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace geoprior {

/// What a text names: nothing, a file that is read, a folder, or either (the frames of a sequence).
enum class Named { nothing, file, folder, file_or_folder };

/// What `describe` says of one option beside key and default.
struct OptionInfo {
  std::string_view doc;        ///< one line of meaning, with the thesis' symbol where it has one
  std::string_view unit = "";  ///< "" for a pure number
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool required = false;         ///< no default: the file must give it
  Named named = Named::nothing;  ///< by a text or by each of several
};

/// The types of options, in the one place that lists them.
template <class... T>
struct OptionTypeList {
  using Value = std::variant<T...>;
  using Reference = std::variant<T*...>;
  template <class X>
  static constexpr bool kHas = (std::is_same_v<X, T> || ...);
};
using OptionTypes =
    OptionTypeList<double, int, bool, std::string, std::vector<double>, std::vector<std::string>,
                   std::optional<double>, std::optional<int>, std::optional<std::string>,
                   std::array<double, 3>, std::array<int, 3>>;
using OptionValue = OptionTypes::Value;
using OptionReference = OptionTypes::Reference;  ///< never null

template <class T>
concept IsOptionType = OptionTypes::kHas<T>;

/// Walks the options of a method or a scene. One `describe` serves parsing, validation, help text
/// and the record.
///
/// Beside every option struct stands `void describe(OptionVisitor& v, XOptions& options)`, which
/// names each member once. A reader assigns to the references it is given, a printer only reads
/// them.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;

  template <IsOptionType T>
  void value(std::string_view key, T& x, const OptionInfo& info) {
    visit_value(key, OptionReference(std::in_place_type<T*>, &x), info);
  }
  /// One of `names`, stored as its index.
  virtual void choice(std::string_view key, int& index, std::span<const std::string_view> names,
                      const OptionInfo& info) = 0;
  /// One of `names` or nothing: without it, something else decides.
  virtual void optional_choice(std::string_view key, std::optional<int>& index,
                               std::span<const std::string_view> names, const OptionInfo& info) = 0;
  /// A nested table that is always there; `inside` describes its members.
  virtual void group(std::string_view key, const OptionInfo& info,
                     const std::function<void()>& inside) = 0;
  /// A table that may be absent: `present` says so and is set by a reader before `inside` is
  /// walked.
  virtual void optional_group(std::string_view key, bool& present, const OptionInfo& info,
                              const std::function<void()>& inside) = 0;
  /// An array of tables of `count` elements; a reader calls `resize` first. `inside(i)` describes
  /// element i; a lister with no elements calls `resize(1)`, so that the members can be listed.
  virtual void list(std::string_view key, std::size_t count, const OptionInfo& info,
                    const std::function<void(std::size_t)>& resize,
                    const std::function<void(std::size_t)>& inside) = 0;

 protected:
  /// What is done to a value; `std::visit` tells its type.
  virtual void visit_value(std::string_view key, const OptionReference& x,
                           const OptionInfo& info) = 0;
};

/// An enum option: `names[i]` is the text of the enumerator of value i.
///
/// A tagged choice: describe the tag first, then the members that it selects, in a `switch`; the
/// reader has set the tag by then.
template <class Enum>
void describe_choice(OptionVisitor& v, std::string_view key, Enum& x,
                     std::span<const std::string_view> names, const OptionInfo& info) {
  int index = static_cast<int>(x);
  v.choice(key, index, names, info);
  x = static_cast<Enum>(index);
}

/// An enum option that may be absent.
template <class Enum>
void describe_choice(OptionVisitor& v, std::string_view key, std::optional<Enum>& x,
                     std::span<const std::string_view> names, const OptionInfo& info) {
  std::optional<int> index;
  if (x) index = static_cast<int>(*x);
  v.optional_choice(key, index, names, info);
  x.reset();
  if (index) x = static_cast<Enum>(*index);
}

/// A nested option struct that has its own `describe`.
template <class Options>
void describe_group(OptionVisitor& v, std::string_view key, Options& options,
                    const OptionInfo& info) {
  v.group(key, info, [&] { describe(v, options); });
}

/// A nested option struct that may be absent.
template <class Options>
void describe_group(OptionVisitor& v, std::string_view key, std::optional<Options>& options,
                    const OptionInfo& info) {
  bool present = options.has_value();
  Options inner = options.value_or(Options{});
  v.optional_group(key, present, info, [&] { describe(v, inner); });
  if (present) {
    options = inner;
  } else {
    options.reset();
  }
}

/// A list of option structs that have their own `describe`.
template <class Options>
void describe_list(OptionVisitor& v, std::string_view key, std::vector<Options>& list,
                   const OptionInfo& info) {
  v.list(
      key, list.size(), info, [&](std::size_t n) { list.resize(n); },
      [&](std::size_t i) { describe(v, list[i]); });
}

}  // namespace geoprior
