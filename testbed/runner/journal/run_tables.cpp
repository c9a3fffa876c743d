#include "testbed/runner/journal/run_tables.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/journal/recorder.h"
#include "testbed/runner/journal/sha256.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

struct TableOfFrame {
  std::size_t frame = 0;
  FrameTable table;
};

FrameTable read_table(const StoredFile& file, const fs::path& run_folder) {
  const fs::path path = path_below(run_folder, file.name);
  const std::string text = read_whole_file(path);
  if (sha256(text) != file.sha256) {
    throw Error("is damaged: its checksum is not the recorded one", path.string());
  }
  return table_from_csv(text, path.string());
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) - names.begin();
}

StackedTable stack(const std::vector<TableOfFrame>& tables) {
  StackedTable out{{"frame"}, {}};
  for (const TableOfFrame& one : tables) {
    for (const std::string& name : one.table.columns) {
      if (index_of(out.columns, name) == out.columns.size()) out.columns.push_back(name);
    }
  }
  for (const TableOfFrame& one : tables) {
    for (const auto& from : one.table.rows.rowwise()) {
      std::vector<double> row(out.columns.size(), std::numeric_limits<double>::quiet_NaN());
      row[0] = static_cast<double>(one.frame);
      for (std::size_t c = 0; c < one.table.columns.size(); ++c) {
        row[index_of(out.columns, one.table.columns[c])] = from(c);
      }
      out.values.insert(out.values.end(), row.begin(), row.end());
    }
  }
  return out;
}

}  // namespace

std::map<std::string, StackedTable> stacked_tables(const VariantRecord& variant,
                                                   const fs::path& run_folder) {
  std::map<std::string, std::vector<TableOfFrame>> by_name;
  for (std::size_t f = 0; f < variant.frames.size(); ++f) {
    for (const StoredFile& file : variant.frames[f].files) {
      const fs::path name(file.name);
      if (name.extension() != ".csv") continue;
      const std::string stem = name.stem().string();
      by_name[stem.substr(0, stem.rfind('_'))].push_back({f, read_table(file, run_folder)});
    }
  }
  std::map<std::string, StackedTable> out;
  for (const auto& [name, tables] : by_name) out[name] = stack(tables);
  return out;
}

}  // namespace geoprior
