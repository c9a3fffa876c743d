#include "experiments/fluid/scene/edit_list.h"

#include "core/error.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::fluid {
namespace {

struct EditList {
  std::vector<Edit> edits;
};

void describe(OptionVisitor& v, EditList& list) {
  describe_list(v, "edit", list.edits, {.doc = "what happens to features, in order"});
}

}  // namespace

std::vector<Edit> parse_edit_list(std::string_view text, const std::string& name) {
  const TomlNode root = parse_toml_text(text, name);
  EditList list;
  read_options(root, "", list);
  if (list.edits.empty()) throw Error("is an edit list without edits", name, "[[edit]] tables");
  const TomlNode& tables = *root.find("edit");
  for (std::size_t i = 0; i < list.edits.size(); ++i) {
    try {
      require_valid(list.edits[i]);
    } catch (const Error& e) {
      throw Error(e.what(), tables.items[i].place);
    }
  }
  return std::move(list.edits);
}

std::vector<Edit> read_edit_list(const std::filesystem::path& file) {
  return parse_edit_list(read_text_file(file), file.string());
}

}  // namespace geoprior::fluid
