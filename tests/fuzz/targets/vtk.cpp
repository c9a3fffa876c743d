#include "testbed/formats/sequence/repair.h"
#include "testbed/formats/vtk/files.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {

void fuzz_vtp(const std::uint8_t* data, std::size_t size) {
  allow_error([&] {
    std::optional<double> time;
    Part part = parse_foreign_vtk_part(std::string(text_of(data, size)), ".vtp", "fuzz", time);
    SurfaceFrame frame;
    frame.mesh = {std::move(part.points), std::move(part.triangles)};
    repair(frame, "fuzz", frame.notes);
  });
}

}  // namespace geoprior::test
