#include "testbed/formats/input_file.h"

#include <cerrno>
#include <system_error>

#include "core/error.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

const char* kind_text(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:
      return "of an unknown kind";
  }
}

std::string reason_of_reading(int error_number) {
  return std::generic_category().message(error_number);
}

}  // namespace

void require_regular_file(const fs::path& file) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (fs::is_regular_file(status)) return;
  if (!fs::exists(status)) {
    throw Error("cannot be read: " + reason_of_reading(code ? code.value() : ENOENT),
                file.string());
  }
  throw Error(std::string("is ") + kind_text(status.type()), file.string(), "a file");
}

std::ifstream open_input_file(const fs::path& file) {
  require_regular_file(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error("cannot be read: " + reason_of_reading(errno), file.string());
  return in;
}

}  // namespace geoprior
