#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// Most bytes of an SVG file; pictures may be embedded in it.
inline constexpr double kMostSvgBytes = 1e8;

/// The elements of an SVG file and where they stand in it. UTF-8; entities of a document type are
/// never expanded, and nothing else is read.
class SvgXml {
 public:
  /// @throws Error  naming the file and the place: unreadable, larger than kMostSvgBytes, nested
  ///                deeper than kMostNesting, no valid XML, an external entity, no SVG
  explicit SvgXml(const std::filesystem::path& file);
  SvgXml(const SvgXml&) = delete;
  SvgXml& operator=(const SvgXml&) = delete;

  [[nodiscard]] pugi::xml_node root() const { return root_; }
  /// True when a style sheet of another file is asked for.
  [[nodiscard]] bool has_outer_style() const { return has_outer_style_; }

  /// Name of an SVG element without its prefix; empty for elements of other vocabularies and for
  /// what is no element.
  [[nodiscard]] std::string_view element(const pugi::xml_node& node) const;
  /// The value of `inkscape:<name>`, whatever the prefix is in this file.
  [[nodiscard]] std::string_view inkscape(const pugi::xml_node& node, const char* name) const;
  /// `href`, or `xlink:href`.
  [[nodiscard]] std::string_view href(const pugi::xml_node& node) const;
  /// The first element of that id, null when there is none.
  [[nodiscard]] pugi::xml_node find(std::string_view id) const;

  [[nodiscard]] std::size_t line(const pugi::xml_node& node) const;
  /// "drawing.svg:12: path 'seam-3'".
  [[nodiscard]] std::string place(const pugi::xml_node& node) const;

 private:
  void parse();
  void check_document_type();
  [[nodiscard]] std::size_t line_at(std::size_t offset) const;

  std::string name_;
  std::string text_;  ///< parsed in place
  std::vector<std::size_t> line_starts_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::string prefix_;  ///< of SVG's elements, with its colon
  std::string inkscape_prefix_ = "inkscape:", xlink_prefix_ = "xlink:";
  bool has_outer_style_ = false;
  mutable std::map<std::string_view, pugi::xml_node> by_id_;  ///< made when it is first needed
};

}  // namespace geoprior
