#include "experiments/embryo/sparql/scratch_folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

#include "core/error.h"

namespace geoprior::embryo {

ScratchFolder::ScratchFolder() {
  std::error_code error;
  std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  if (error) parent = "/tmp";
  std::string name = (parent / "geoprior-query-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw Error("no folder can be made for temporary files", parent.string(),
                "set TMPDIR to one that can be written");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace geoprior::embryo
