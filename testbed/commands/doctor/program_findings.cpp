#include "core/error.h"
#include "testbed/commands/doctor/findings.h"
#include "testbed/images/image_codec.h"
#include "testbed/view/child_process.h"

namespace geoprior {
namespace {

/// The first line of what `<program> <flag>` prints.
std::string first_line_printed(const std::string& program, const std::string& flag) {
  const ChildResult result =
      run_child({"/bin/sh", "-c", R"(exec "$1" "$2" >&2)", "sh", program, flag});
  return result.errors.substr(0, result.errors.find('\n'));
}

Finding optional_program(const std::string& name, const std::string& flag,
                         const std::string& needed_for) {
  Finding finding{.what = name,
                  .where = "not in PATH",
                  .needed_for = needed_for,
                  .get = "apt-get install " + name};
  if (const auto program = find_program(name)) {
    finding.found = true;
    finding.where = *program + ", " + first_line_printed(*program, flag);
  }
  return finding;
}

Finding image_module_finding() {
  Finding finding{.what = "pictures of others",
                  .found = true,
                  .where = "geoprior_images.so",
                  .needed_for = "photographs, textures and maps as PNG, JPEG, EXR",
                  .get = "build or install geoprior again: the module comes with it"};
  try {
    image_codec();
  } catch (const Error& error) {
    finding.found = false;
    finding.where = error.what();
  }
  return finding;
}

}  // namespace

std::vector<Finding> program_findings() {
  return {image_module_finding(),
          optional_program("ffmpeg", "-version", "`video` as one file; without it pictures"),
          optional_program("blender", "--version",
                           "opening what `export --format glb` writes; examples/external/blender "
                           "makes its frames anew with it")};
}

}  // namespace geoprior
