#include "experiments/sketch/fabrication/textured_files.h"

#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/pattern/sheet_text.h"

namespace geoprior::sketch {
namespace {

constexpr const char* kTextureFile = "texture.png";

/// The surface as Wavefront OBJ. Texture coordinates run from the lower left corner.
std::string obj_text(const OneViewResult& result, const Pattern& pattern, const PixelGrid& grid) {
  constexpr int kDigits = 7;
  std::string text = "mtllib model.mtl\nusemtl photograph\n";
  const Eigen::MatrixX3d& V = result.surface.mesh.V;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    text += "v";
    for (int k = 0; k < 3; ++k) text.append(" ").append(written_number(V(v, k), kDigits));
    text += "\n";
  }
  const Eigen::Vector2d size = grid.pixel * Eigen::Vector2d(grid.width, grid.height);
  std::string faces;
  Eigen::Index first = 1;
  for (const PatternPiece& piece : pattern.pieces) {
    for (Eigen::Index p = 0; p < piece.points.rows(); ++p) {
      const Eigen::Vector2d at = piece.points.row(p).transpose();
      const Eigen::Vector2d uv = (at - grid.origin).cwiseQuotient(size);
      text.append("vt ").append(written_number(uv.x(), kDigits));
      text.append(" ").append(written_number(uv.y(), kDigits)).append("\n");
    }
    std::string name = piece.name;
    for (char& c : name) c = c == ' ' ? '_' : c;
    faces += "g " + name + "\n";
    for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
      faces += "f";
      for (int k = 0; k < 3; ++k) {
        const int p = piece.triangles(t, k);
        faces.append(" ").append(std::to_string(piece.surface_vertex[p] + 1));
        faces.append("/").append(std::to_string(first + p));
      }
      faces += "\n";
    }
    first += piece.points.rows();
  }
  return text + faces;
}

std::string mtl_text() {
  return std::string("newmtl photograph\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd ") +
         kTextureFile + "\n";
}

/// The picture under the outlines of the pieces, in millimetres.
std::string textured_svg(const Pattern& pattern, const PixelGrid& grid) {
  const Eigen::Vector2d size = 1e3 * grid.pixel * Eigen::Vector2d(grid.width, grid.height);
  const std::string w = written_number(size.x()), h = written_number(size.y());
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "width=\"" +
      w + "mm\" height=\"" + h + "mm\" viewBox=\"0 0 " + w + " " + h + "\">\n<image href=\"" +
      kTextureFile + "\" x=\"0\" y=\"0\" width=\"" + w + "\" height=\"" + h +
      "\" preserveAspectRatio=\"none\"/>\n<g id=\"cut\" fill=\"none\" stroke=\"#ff0000\" "
      "stroke-width=\"0.2\">\n";
  for (const PatternPiece& piece : pattern.pieces) {
    for (const std::vector<int>& border : piece.borders) {
      text += "<path data-name=\"" + xml_text(label_text(piece.name, 100)) + "\" d=\"";
      for (std::size_t i = 0; i < border.size(); ++i) {
        const Eigen::Vector2d at = 1e3 * (piece.points.row(border[i]).transpose() - grid.origin);
        text += (i == 0 ? "M " : " L ") + written_number(at.x()) + "," +
                written_number(size.y() - at.y());
      }
      text += " Z\"/>\n";
    }
  }
  return text + "</g>\n</svg>\n";
}

}  // namespace

void describe(OptionVisitor& v, TexturedFileOptions& options) { describe(v, options.bake); }

TexturedFiles textured_files(const View& view, const PixelImage& photo, const OneViewResult& result,
                             const Pattern& pattern, const TexturedFileOptions& options) {
  const BakedPattern baked = bake_pattern(view, photo, result, pattern, options.bake);
  TexturedFiles made;
  made.files = {{kTextureFile, png_bytes(baked.image, 1 / baked.grid.pixel)},
                {"textured-pattern.svg", textured_svg(pattern, baked.grid)},
                {"model.obj", obj_text(result, pattern, baked.grid)},
                {"model.mtl", mtl_text()}};
  made.diagnostics = {{"texture_seen", baked.seen},
                      {"texture_mirrored", baked.mirrored},
                      {"texture_flat", baked.flat}};
  return made;
}

}  // namespace geoprior::sketch
