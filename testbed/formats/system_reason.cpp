#include "testbed/formats/system_reason.h"

#include <cerrno>
#include <system_error>

namespace geoprior {

std::string system_reason(int error_number) {
  const std::string text = std::generic_category().message(error_number);
  switch (error_number) {
    case ENOSPC:
      return "disk full: " + text;
    case EDQUOT:
      return "disk quota used up: " + text;
    case EFBIG:
      return "file size limit reached: " + text;
    case EACCES:
    case EPERM:
    case EROFS:
      return "not writable: " + text;
    default:
      return text;
  }
}

}  // namespace geoprior
