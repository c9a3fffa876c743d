#include "testbed/formats/text/xml.h"

#include <algorithm>
#include <system_error>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/formats/input_file.h"
#include "testbed/formats/text/nesting.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

void require_svg_size(const std::filesystem::path& file) {
  require_regular_file(file);
  std::error_code unknown;
  const auto bytes = static_cast<double>(std::filesystem::file_size(file, unknown));
  if (!unknown && bytes > kMostSvgBytes) {
    throw Error("is too large for a drawing: " + bytes_text(bytes), file.string(),
                "at most " + bytes_text(kMostSvgBytes));
  }
}

/// The prefix under which the root declares a vocabulary, with its colon.
std::string declared_prefix(const pugi::xml_node& root, std::string_view vocabulary,
                            std::string otherwise) {
  constexpr std::string_view kDeclares = "xmlns:";
  for (const pugi::xml_attribute& attribute : root.attributes()) {
    const std::string_view name = attribute.name();
    if (name.starts_with(kDeclares) && vocabulary == attribute.value())
      return std::string(name.substr(kDeclares.size())) + ":";
  }
  return otherwise;
}

}  // namespace

SvgXml::SvgXml(const std::filesystem::path& file) : name_(file.string()) {
  require_svg_size(file);
  text_ = read_text_file(file);
  if (text_.find('\0') != std::string::npos)
    throw Error("is no text in UTF-8", name_, "an SVG file that is encoded in UTF-8");
  require_shallow_xml(text_, name_);
  line_starts_.push_back(0);
  for (std::size_t at = text_.find('\n'); at != std::string::npos; at = text_.find('\n', at + 1))
    line_starts_.push_back(at + 1);
  parse();
  check_document_type();
  root_ = document_.document_element();
  const std::string_view root_name = root_.name();
  const std::size_t colon = root_name.find(':');
  prefix_ = colon == std::string_view::npos ? "" : root_name.substr(0, colon + 1);
  if (element(root_) != "svg") {
    throw Error("is no SVG file: its first element is <" + std::string(root_name) + ">", name_,
                "<svg>");
  }
  inkscape_prefix_ = declared_prefix(root_, "http://www.inkscape.org/namespaces/inkscape",
                                     std::move(inkscape_prefix_));
  xlink_prefix_ = declared_prefix(root_, "http://www.w3.org/1999/xlink", std::move(xlink_prefix_));
}

void SvgXml::parse() {
  const pugi::xml_parse_result parsed = document_.load_buffer_inplace(
      text_.data(), text_.size(), pugi::parse_default | pugi::parse_doctype | pugi::parse_pi,
      pugi::encoding_utf8);
  if (!parsed) {
    throw Error("no valid XML: " + std::string(parsed.description()),
                name_ + ":" + std::to_string(line_at(parsed.offset)), "an SVG file");
  }
}

void SvgXml::check_document_type() {
  for (const pugi::xml_node& node : document_) {
    if (node.type() == pugi::node_pi && std::string_view(node.name()) == "xml-stylesheet")
      has_outer_style_ = true;
    if (node.type() != pugi::node_doctype) continue;
    const std::string_view type = node.value();
    for (std::size_t at = type.find("<!ENTITY"); at != std::string_view::npos;
         at = type.find("<!ENTITY", at + 1)) {
      const std::string_view entity = type.substr(at, type.find('>', at) - at);
      if (entity.find("SYSTEM") == std::string_view::npos &&
          entity.find("PUBLIC") == std::string_view::npos)
        continue;
      throw Error("declares an entity of another file, which is never read: '" +
                      std::string(entity.substr(0, 200)) + ">'",
                  name_ + ":" + std::to_string(line(node)), "a drawing in one file");
    }
  }
}

std::string_view SvgXml::element(const pugi::xml_node& node) const {
  const std::string_view name = node.name();
  if (node.type() != pugi::node_element || !name.starts_with(prefix_)) return {};
  const std::string_view local = name.substr(prefix_.size());
  return local.find(':') == std::string_view::npos ? local : std::string_view();
}

std::string_view SvgXml::inkscape(const pugi::xml_node& node, const char* name) const {
  return node.attribute((inkscape_prefix_ + name).c_str()).value();
}

std::string_view SvgXml::href(const pugi::xml_node& node) const {
  const std::string_view plain = node.attribute("href").value();
  return plain.empty() ? node.attribute((xlink_prefix_ + "href").c_str()).value() : plain;
}

pugi::xml_node SvgXml::find(std::string_view id) const {
  if (by_id_.empty()) {
    struct Walker : pugi::xml_tree_walker {
      std::map<std::string_view, pugi::xml_node>* by_id = nullptr;
      bool for_each(pugi::xml_node& node) override {
        const std::string_view name = node.attribute("id").value();
        if (!name.empty()) by_id->emplace(name, node);
        return true;
      }
    } walker;
    walker.by_id = &by_id_;
    by_id_.emplace("", pugi::xml_node());
    pugi::xml_node(document_.document_element()).traverse(walker);
  }
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? pugi::xml_node() : found->second;
}

std::size_t SvgXml::line_at(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return after - line_starts_.begin();
}

std::size_t SvgXml::line(const pugi::xml_node& node) const {
  return line_at(std::max<std::ptrdiff_t>(0, node.offset_debug()));
}

std::string SvgXml::place(const pugi::xml_node& node) const {
  const std::string_view local = element(node);
  const std::string_view id = node.attribute("id").value();
  std::string place = name_ + ":" + std::to_string(line(node));
  place += ": " + (local.empty() ? std::string(node.name()) : std::string(local));
  if (!id.empty()) place += " '" + std::string(id.substr(0, 200)) + "'";
  return place;
}

}  // namespace geoprior
