#pragma once

#include <string>
#include <string_view>

#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// @param room  "frames", "artifacts" or "checkpoints"
/// @throws Error  unless the file is `<room>/<case>/<variant>/<name>`
void require_stored_file(const StoredFile& file, std::string_view room, const journal::Place& place,
                         const std::string& where);

/// The names of a run that was read: its cases, variants and studies, the files of frames and
/// artifacts, the numbers of its events.
/// @throws Error  naming file and place
void require_names(const RunRecord& record, const std::string& file);

}  // namespace geoprior
