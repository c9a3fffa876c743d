#include "testbed/formats/text/text_file.h"

#include <utility>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"

namespace geoprior {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

/// The encoding that the first bytes show, empty for one of single bytes. No text of ours begins
/// with a zero, and two characters of ASCII have one between them in the wider encodings.
std::string_view wide_encoding(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xFE\0\0"sv) || bytes.starts_with("\0\0\xFE\xFF"sv)) return "UTF-32";
  if (bytes.starts_with("\xFF\xFE"sv) || bytes.starts_with("\xFE\xFF"sv)) return "UTF-16";
  const auto zero = [&](std::size_t at) { return bytes[at] == '\0'; };
  if (bytes.size() < 4) return {};
  if (zero(1) && zero(2) && !zero(0) && zero(3)) return "UTF-32";
  if (zero(0) && zero(1) && zero(2) && !zero(3)) return "UTF-32";
  if (!zero(0) && zero(1) && !zero(2) && zero(3)) return "UTF-16";
  if (zero(0) && !zero(1) && zero(2) && !zero(3)) return "UTF-16";
  return {};
}

/// \r\n and \r become \n, in place.
void unify_line_ends(std::string& text) {
  std::size_t to = text.find('\r');
  if (to == std::string::npos) return;
  for (std::size_t from = to; from < text.size(); ++from) {
    const bool carriage_return = text[from] == '\r';
    if (carriage_return && from + 1 < text.size() && text[from + 1] == '\n') continue;
    text[to++] = carriage_return ? '\n' : text[from];
  }
  text.resize(to);
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view bytes, const std::string& name) {
  const std::string_view encoding = wide_encoding(bytes);
  if (!encoding.empty()) {
    throw Error("is text in " + std::string(encoding), name,
                "UTF-8: save it so in the editor, or iconv -f " + std::string(encoding) +
                    " -t UTF-8 FILE > NEW");
  }
  if (bytes.starts_with(kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  return bytes;
}

std::string plain_text(std::string bytes, const std::string& name) {
  const std::size_t mark = bytes.size() - without_byte_order_mark(bytes, name).size();
  bytes.erase(0, mark);
  unify_line_ends(bytes);
  return bytes;
}

std::string read_text_file(const std::filesystem::path& file) {
  return plain_text(read_whole_file(file), file.string());
}

}  // namespace geoprior
