#include "tests/fuzz/sample_layouts.h"

#include <sstream>
#include <string>

#include "core/frame.h"
#include "testbed/formats/gltf/writer.h"
#include "tests/testbed/formats/octahedron.h"

namespace geoprior::test {
namespace {

using On = NamedArray::On;

/// "property double name_0" … of a row of the arrays.
std::string ply_properties(const Part& part, On on) {
  std::string text;
  for (const NamedArray& array : part.arrays) {
    for (Eigen::Index k = 0; array.on == on && k < array.values.cols(); ++k) {
      const bool single = array.values.cols() == 1;
      text += "property double " + array.name + (single ? "" : "_" + std::to_string(k)) + "\n";
    }
  }
  return text;
}

void put_row(std::ostream& out, const Part& part, On on, Eigen::Index row) {
  for (const NamedArray& array : part.arrays) {
    if (array.on == on) out << " " << array.values.row(row);
  }
  out << "\n";
}

std::string text_ply(const Part& part) {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << part.points.rows()
      << "\nproperty double x\nproperty double y\nproperty double z\n"
      << ply_properties(part, On::points);
  if (part.kind == Part::Kind::triangles) {
    out << "element face " << part.triangles.rows() << "\nproperty list uchar int vertex_indices\n";
  } else if (part.kind == Part::Kind::lines) {
    out << "element edge " << part.lines.size() << "\nproperty int vertex1\nproperty int vertex2\n";
  }
  out << ply_properties(part, On::cells) << "end_header\n";
  for (Eigen::Index v = 0; v < part.points.rows(); ++v) {
    out << part.points.row(v);
    put_row(out, part, On::points, v);
  }
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    out << "3 " << part.triangles.row(t);
    put_row(out, part, On::cells, t);
  }
  for (const std::vector<int>& line : part.lines) out << line[0] << " " << line[1] << "\n";
  return out.str();
}

std::string text_vtp(const Part& part) {
  std::ostringstream out;
  const auto array = [&](const char* type, const std::string& name, const auto& values) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << values.cols() << "\" format=\"ascii\">\n"
        << values << "\n</DataArray>\n";
  };
  out << "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n"
      << "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\""
      << " format=\"ascii\">0</DataArray></FieldData>\n<Piece NumberOfPoints=\""
      << part.points.rows() << "\" NumberOfPolys=\"" << part.triangles.rows() << "\">\n<Points>\n";
  array("Float64", "Points", part.points);
  out << "</Points>\n<PointData>\n";
  for (const NamedArray& each : part.arrays) array("Float64", each.name, each.values);
  out << "</PointData>\n<Polys>\n";
  array("Int64", "connectivity", part.triangles.reshaped<Eigen::RowMajor>().eval());
  array("Int64", "offsets",
        Eigen::VectorXi::LinSpaced(part.triangles.rows(), 3,
                                   3 * static_cast<int>(part.triangles.rows()))
            .eval());
  out << "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return out.str();
}

/// Heights and their rates at 4 x 4 places of a sea.
std::string text_vti() {
  std::ostringstream out;
  out << "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      << "<ImageData WholeExtent=\"0 3 0 3 0 0\" Origin=\"0 0 0\" Spacing=\"0.5 0.25 1\">\n"
      << "<Piece Extent=\"0 3 0 3 0 0\">\n<PointData>\n";
  for (const char* name : {"height", "rate"}) {
    out << "<DataArray type=\"Float64\" Name=\"" << name << "\" format=\"ascii\">\n"
        << Eigen::RowVectorXd::LinSpaced(16, -0.15, 0.15) << "\n</DataArray>\n";
  }
  out << "</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n";
  return out.str();
}

std::string text_obj(const TriMesh& mesh) {
  std::ostringstream out;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) out << "v " << mesh.V.row(v) << "\n";
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    out << "f " << (mesh.F.row(t).array() + 1) << "\n";
  }
  return out.str();
}

std::string numbered(const std::string& part, int frame) {
  return "frames/" + part + "_000" + std::to_string(frame);
}

/// A strip of four squares along x that is bent a little in each frame.
Part strip(int frame) {
  Part part;
  Eigen::MatrixX2d pattern(10, 2);
  part.points.resize(10, 3);
  part.triangles.resize(8, 3);
  for (int i = 0; i < 10; ++i) {
    pattern.row(i) << 0.05 * (i / 2) - 0.1, 0.1 * (i % 2) - 0.05;
    part.points.row(i) << pattern.row(i), 0.002 * frame * (i / 2) * (4 - i / 2);
  }
  for (int i = 0; i < 4; ++i) {
    part.triangles.row(2 * i) << 2 * i, 2 * i + 2, 2 * i + 3;
    part.triangles.row(2 * i + 1) << 2 * i, 2 * i + 3, 2 * i + 1;
  }
  part.arrays = {{"pattern", "m", On::points, pattern},
                 {"velocity", "m/s", On::points, Eigen::MatrixX3d::Constant(10, 3, 0.25)},
                 {"plastic_curvature", "1/m", On::cells, Eigen::MatrixX3d::Constant(8, 3, 0.5)}};
  return part;
}

/// One at each end of the strip, that pull it apart.
Part hands() {
  Part part;
  part.kind = Part::Kind::points;
  part.points = Eigen::MatrixX3d::Zero(2, 3);
  part.points.col(0) << -0.1, 0.1;
  part.arrays = {{"handle", "1", On::points, Eigen::Vector2d(0, 1)},
                 {"force", "N", On::points, part.points}};
  return part;
}

/// One from a cut of the scene into the middle.
Part tear(int frame) {
  Part part;
  part.kind = Part::Kind::lines;
  part.points = Eigen::MatrixX3d::Zero(3, 3);
  part.points.col(1) << -0.05, -0.02, 0.01 * frame;
  part.lines = {{0, 1}, {1, 2}};
  part.arrays = {{"pattern", "m", On::points, part.points.leftCols<2>()},
                 {"time", "s", On::points, Eigen::Vector3d(0, 0, 0.03)},
                 {"lip", "1", On::points, Eigen::Vector3d::Zero()}};
  return part;
}

}  // namespace

Files water_layout() {
  const auto mesh = [](double radius) { return octahedron(radius, {1, 0.5, 0.5}); };
  const auto surface = [&](double radius) {
    Part part;
    part.points = mesh(radius).V;
    part.triangles = mesh(radius).F;
    Eigen::VectorXd feature = Eigen::VectorXd::Ones(6);
    feature(0) = 0;
    part.arrays = {{"feature", "1", On::points, feature},
                   {"velocity", "m/s", On::points, part.points}};
    return part;
  };
  Part particles;
  particles.kind = Part::Kind::points;
  particles.points = mesh(0.3).V;
  return {
      {"frames/surface_0000.vtp", text_vtp(surface(0.3))},
      {"frames/particles_0000.ply", text_ply(particles)},
      {"frames/samples_0000.vti", text_vti()},
      {"frames/sea_0000.csv",
       "\"depth [m]\",\"gravity [m/s^2]\",\"wind [deg]\",\"variance [m^2]\"\n10,9.81,30,0.01\n"},
      {"frames/surface_0001.ply", text_ply(surface(0.4))},
      {"frames/surface_0002.obj", text_obj(mesh(0.45))},
      {"frames/surface_0003.glb", surface_glb(mesh(0.5), "surface")},
      {"frames.csv", "frame,parameter\n0,0\n1,0.04\n2,0.08\n3,0.12\n"},
      {"diagnostics.csv", "frame,iterations,residual\n0,12,1e-9\n1,,0.5\n3,7,\n"},
      {"events.csv",
       "time_s,kind,x,y,z,energy_J,duration_s,area_m2\n"
       "0.02,splash,1,0.5,0.25,1e-3,0.01,0.5\n0.05,\"drop, late\",0,0,0,0,0,\n"},
      {"artifacts/note.txt", "four frames\n"},
  };
}

Files sheet_layout() {
  Files files{{"frames.csv", "frame,parameter\n0,0\n1,0.02\n2,0.04\n"},
              {"diagnostics.csv", "frame,handle_work\n0,0\n1,0.01\n2,\n"},
              {"events.csv",
               "time_s,kind,x,y,z,energy_J,duration_s,area_m2\n"
               "0.01,crac,0,-0.02,0,1e-3,0.01,0.5\n0.03,\"flap, late\",0,0,0,0,0,\n"}};
  for (int frame = 0; frame < 3; ++frame) {
    files[numbered("surface", frame) + ".ply"] = text_ply(strip(frame));
    files[numbered("handles", frame) + ".ply"] = text_ply(hands());
    files[numbered("tears", frame) + ".ply"] = text_ply(tear(frame));
  }
  return files;
}

}  // namespace geoprior::test
