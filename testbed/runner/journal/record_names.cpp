#include "testbed/runner/journal/record_names.h"

#include <vector>

#include "core/error.h"
#include "testbed/runner/journal/event_table.h"
#include "testbed/runner/names.h"

namespace geoprior {

namespace {

void require_file_of_variant(const std::vector<StoredFile>& files, std::string_view room,
                             const journal::Place& place, const std::string& where) {
  for (const StoredFile& file : files) require_stored_file(file, room, place, where);
}

void require_names(const CaseRecord& one, const std::string& cases) {
  require_name(one.name, "a case", cases);
  const std::string variants = cases + "/" + one.name + "/variants";
  for (const VariantRecord& variant : one.variants) {
    require_plain_name(variant.name, "a variant", variants);
    const journal::Place place{one.name, variant.name};
    const std::string group = variants + "/" + variant.name;
    for (const FrameRecord& frame : variant.frames) {
      require_file_of_variant(frame.files, "frames", place, group + "/frames");
    }
    require_file_of_variant(variant.artifacts, "artifacts", place, group + "/artifacts");
    for (const Event& event : variant.events) require_event_numbers(event, group + "/events");
  }
}

}  // namespace

void require_stored_file(const StoredFile& file, std::string_view room, const journal::Place& place,
                         const std::string& where) {
  const std::string folder = std::string(room) + "/" + place.case_name + "/" + place.variant + "/";
  const std::string_view name = file.name;
  if (name.starts_with(folder) && is_file_name(name.substr(folder.size()))) return;
  throw Error(quoted_name(name) + " is no file of this place of a run", where, folder + "<name>");
}

void require_names(const RunRecord& record, const std::string& file) {
  require_experiment_id(record.experiment_id, file + ": /@experiment_id");
  for (const CaseRecord& one : record.cases) require_names(one, file + ": /cases");
  for (const StudyRecord& study : record.studies) {
    require_text_name(study.name, "a study", file + ": /study");
  }
}

}  // namespace geoprior
