#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// Properties of CSS with their values.
using SvgProperties = std::map<std::string, std::string, std::less<>>;

/// One declaration: "stroke: red !important".
struct SvgDeclaration {
  std::string name, value;
  bool important = false;
};

/// What a text as in an attribute `style` declares, in its order. What is no declaration is left
/// out, as in browsers.
std::vector<SvgDeclaration> parse_svg_declarations(std::string_view text);

/// What selectors look at.
struct SvgElementName {
  std::string_view element;
  std::string_view id;
  std::vector<std::string_view> classes;
};

/// The rules of <style> elements. Selectors are an element or `*`, a class, an id, these joined
/// without blanks ("path.seam"), and lists of them; others match nothing and are named in
/// `ignored`. Nothing is ever read from another file.
class SvgStyleSheet {
 public:
  /// @param ignored  gets a line for each selector and each @-rule that is not understood
  /// @throws Error   at `where` when there are more than kMostRules
  void add(std::string_view css, const std::string& where, std::vector<std::string>& ignored);

  /// What holds of an element: presentation attributes, then rules, by their specificity and
  /// order, then its own style; among each other what is important comes last.
  [[nodiscard]] SvgProperties cascade(const SvgElementName& element,
                                      const SvgProperties& attributes,
                                      std::string_view style) const;

  [[nodiscard]] std::size_t size() const { return rules_.size(); }

  static constexpr std::size_t kMostRules = 2000;

 private:
  struct Rule {
    std::string element;  ///< empty: any
    std::string id;       ///< empty: any
    std::vector<std::string> classes;
    std::vector<SvgDeclaration> declarations;
    [[nodiscard]] bool matches(const SvgElementName& name) const;
    [[nodiscard]] std::size_t specificity() const;
  };
  static bool parse_selector(std::string_view text, Rule& rule);
  void add_rules(std::string_view selectors, std::string_view block, const std::string& where,
                 std::vector<std::string>& ignored);

  std::vector<Rule> rules_;
};

}  // namespace geoprior
