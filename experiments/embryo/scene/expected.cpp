#include "experiments/embryo/scene/expected.h"

#include <algorithm>

#include "core/error.h"
#include "core/options.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/runner/options/listing.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::embryo {

void describe(OptionVisitor& v, ExpectedChanges& changes) {
  v.value("absent", changes.absent, {.doc = "structures that never exist under the disease"});
  v.value("altered", changes.altered,
          {.doc = "structures that are otherwise, or at other days, than without the disease"});
}

ExpectedChanges read_expected_changes(const std::filesystem::path& file,
                                      const std::string& disease) {
  const TomlNode root = parse_toml_text(read_text_file(file), file.string());
  const TomlNode* table = root.find(disease);
  if (table == nullptr)
    throw Error("has no table '" + disease + "'", file.string(), allowed_names(disease, root.keys));
  ExpectedChanges changes;
  read_options(*table, disease, changes);
  std::sort(changes.absent.begin(), changes.absent.end());
  std::sort(changes.altered.begin(), changes.altered.end());
  return changes;
}

TopicFile expected_keys() {
  ExpectedChanges changes;
  return {"expected", "what each disease is expected to change", "[<disease>]",
          list_options([&](OptionVisitor& v) { describe(v, changes); })};
}

}  // namespace geoprior::embryo
