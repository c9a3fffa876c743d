// Edit lists come from editors of every system.

#include <gtest/gtest.h>

#include "experiments/fluid/scene/edit_list.h"
#include "tests/support/text_forms.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::fluid {
namespace {

using EditListForms = test::ScratchFolder;

TEST_F(EditListForms, AreReadAlike) {
  const std::string text =
      "# two\n[[edit]]\nname = \"a\"\nsource = \"boat\"\nids = [\n3,\n4]\n\n[[edit]]\nname = 'b'\n"
      "source = \"boat\"\nturn_deg = 30\n";
  for (const test::TextForm& form : test::text_forms(text)) {
    const std::vector<Edit> edits = read_edit_list(write("edits.toml", form.bytes));
    ASSERT_EQ(edits.size(), 2U) << form.name;
    EXPECT_EQ(edits[0].ids, (std::vector<double>{3, 4})) << form.name;
    EXPECT_EQ(edits[1].turn_deg, 30) << form.name;
  }
  const auto wide = write("edits.toml", test::in_utf16(text));
  test::expect_error([&] { (void)read_edit_list(wide); }, {"edits.toml", "UTF-16"});
}

}  // namespace
}  // namespace geoprior::fluid
