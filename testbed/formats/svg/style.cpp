#include "testbed/formats/svg/style.h"

#include <algorithm>

#include "core/error.h"
#include "testbed/formats/text/letters.h"

namespace geoprior {
namespace {

constexpr std::string_view kCssSpace = " \t\r\n\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kCssSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kCssSpace) - first + 1);
}

/// The first of `marks` outside of quotes and round brackets, from `at` on; the size at the end.
std::size_t find_outside(std::string_view text, std::string_view marks, std::size_t at) {
  int brackets = 0;
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == '\\') ++at;
      if (c == quote) quote = 0;
      continue;
    }
    if (brackets <= 0 && marks.find(c) != std::string_view::npos) return at;
    if (c == '"' || c == '\'') quote = c;
    if (c == '(') ++brackets;
    if (c == ')') --brackets;
  }
  return text.size();
}

/// Behind the '}' that closes the '{' at `open`.
std::size_t past_block(std::string_view css, std::size_t open) {
  int depth = 0;
  for (std::size_t at = open; at < css.size(); at = find_outside(css, "{}", at + 1)) {
    depth += css[at] == '{' ? 1 : -1;
    if (depth == 0) return at + 1;
  }
  return css.size();
}

std::string without_comments(std::string_view css) {
  std::string text;
  for (std::size_t at = 0; at < css.size();) {
    const std::size_t begin = std::min(css.find("/*", at), css.size());
    text += css.substr(at, begin - at);
    const std::size_t end = begin == css.size() ? begin : css.find("*/", begin + 2);
    at = end >= css.size() ? css.size() : end + 2;
  }
  for (const std::string_view mark : {"<!--", "-->"}) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at))
      text.replace(at, mark.size(), mark.size(), ' ');
  }
  return text;
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

std::string_view take_name(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_name_character);
  const std::string_view name = text.substr(0, end - text.begin());
  text.remove_prefix(name.size());
  return name;
}

}  // namespace

std::vector<SvgDeclaration> parse_svg_declarations(std::string_view text) {
  std::vector<SvgDeclaration> declarations;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = find_outside(text, ";", at);
    const std::string_view part = text.substr(at, end - at);
    at = end + 1;
    const std::size_t colon = part.find(':');
    if (colon == std::string_view::npos) continue;
    SvgDeclaration declaration;
    declaration.name = lower(trimmed(part.substr(0, colon)));
    std::string_view value = trimmed(part.substr(colon + 1));
    const std::size_t mark = value.rfind('!');
    if (mark != std::string_view::npos && lower(trimmed(value.substr(mark + 1))) == "important") {
      declaration.important = true;
      value = trimmed(value.substr(0, mark));
    }
    declaration.value = value;
    if (!declaration.name.empty() && !value.empty()) declarations.push_back(declaration);
  }
  return declarations;
}

bool SvgStyleSheet::Rule::matches(const SvgElementName& name) const {
  if (!element.empty() && element != name.element) return false;
  if (!id.empty() && id != name.id) return false;
  return std::all_of(classes.begin(), classes.end(), [&](const std::string& wanted) {
    return std::find(name.classes.begin(), name.classes.end(), wanted) != name.classes.end();
  });
}

std::size_t SvgStyleSheet::Rule::specificity() const {
  constexpr std::size_t kMostClasses = 999;
  return (id.empty() ? 0 : 10000) + std::min(classes.size(), kMostClasses) * 10 +
         (element.empty() ? 0 : 1);
}

bool SvgStyleSheet::parse_selector(std::string_view text, Rule& rule) {
  if (text.starts_with('*')) {
    text.remove_prefix(1);
  } else {
    rule.element = take_name(text);
  }
  while (!text.empty()) {
    const char mark = text[0];
    text.remove_prefix(1);
    const std::string_view name = take_name(text);
    if (name.empty() || (mark != '.' && mark != '#')) return false;
    if (mark == '.') {
      rule.classes.emplace_back(name);
    } else if (rule.id.empty()) {
      rule.id = name;
    } else {
      return false;
    }
  }
  return true;
}

void SvgStyleSheet::add_rules(std::string_view selectors, std::string_view block,
                              const std::string& where, std::vector<std::string>& ignored) {
  const std::vector<SvgDeclaration> declarations = parse_svg_declarations(block);
  for (std::size_t at = 0; at <= selectors.size();) {
    const std::size_t end = find_outside(selectors, ",", at);
    const std::string_view selector = trimmed(selectors.substr(at, end - at));
    at = end + 1;
    Rule rule;
    if (selector.empty()) continue;
    if (!parse_selector(selector, rule)) {
      ignored.push_back("the selector '" + std::string(selector) + "'");
      continue;
    }
    if (rules_.size() == kMostRules) {
      throw Error("has too many rules of style", where, "at most " + std::to_string(kMostRules));
    }
    rule.declarations = declarations;
    rules_.push_back(std::move(rule));
  }
}

void SvgStyleSheet::add(std::string_view css, const std::string& where,
                        std::vector<std::string>& ignored) {
  const std::string text = without_comments(css);
  const std::string_view rest(text);
  for (std::size_t at = 0; at < rest.size();) {
    at = rest.find_first_not_of(kCssSpace, at);
    if (at == std::string_view::npos) return;
    const std::size_t open = find_outside(rest, rest[at] == '@' ? "{;" : "{", at);
    const std::string_view head = trimmed(rest.substr(at, open - at));
    const bool has_block = open < rest.size() && rest[open] == '{';
    const std::size_t end = has_block ? past_block(rest, open) : open + 1;
    if (head.starts_with('@')) {
      ignored.push_back("the rule '" + std::string(head) + "'");
    } else if (has_block) {
      add_rules(head, rest.substr(open + 1, end - open - 2), where, ignored);
    }
    at = end;
  }
}

SvgProperties SvgStyleSheet::cascade(const SvgElementName& element, const SvgProperties& attributes,
                                     std::string_view style) const {
  std::vector<const Rule*> found;
  for (const Rule& rule : rules_) {
    if (rule.matches(element)) found.push_back(&rule);
  }
  std::stable_sort(found.begin(), found.end(), [](const Rule* a, const Rule* b) {
    return a->specificity() < b->specificity();
  });
  const std::vector<SvgDeclaration> own = parse_svg_declarations(style);
  SvgProperties result = attributes;
  for (const bool important : {false, true}) {
    const auto apply = [&](const std::vector<SvgDeclaration>& declarations) {
      for (const SvgDeclaration& declaration : declarations) {
        if (declaration.important == important) result[declaration.name] = declaration.value;
      }
    };
    for (const Rule* rule : found) apply(rule->declarations);
    apply(own);
  }
  return result;
}

}  // namespace geoprior
