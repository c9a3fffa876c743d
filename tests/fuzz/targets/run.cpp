#include <sstream>
#include <string>

#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/reference/parser.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {

void fuzz_journal(const std::uint8_t* data, std::size_t size) {
  std::istringstream lines{std::string(text_of(data, size))};
  std::string line;
  while (std::getline(lines, line)) {
    // What is read can be written, and read again.
    allow_error([&] { journal::from_text(journal::to_text(journal::from_text(line))); });
  }
}

void fuzz_reference(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_reference(std::string(text_of(data, size)), "fuzz"); });
}

void fuzz_table(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { table_from_csv(std::string(text_of(data, size)), "fuzz"); });
}

}  // namespace geoprior::test
