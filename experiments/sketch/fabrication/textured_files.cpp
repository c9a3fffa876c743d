#include "experiments/sketch/fabrication/textured_files.h"

#include <utility>

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

void describe(OptionVisitor& v, TexturedFileOptions& options) {
  describe(v, options.bake);
  v.value(
      "background", options.background,
      {.doc = "colour of the photograph's background, #rrggbb, of a picture of which it is known: "
              "then texels beside borders are recorded and measured against it"});
}

Part border_texels(const PixelImage& image, const PixelGrid& grid, const Pattern& pattern) {
  constexpr int kBeside = 2;
  std::vector<std::size_t> found;
  for (const PatternPiece& piece : pattern.pieces) {
    TriMesh flat{Eigen::MatrixX3d::Zero(piece.points.rows(), 3), piece.triangles};
    flat.V.leftCols<2>() = piece.points;
    const NearestTriangles covered = nearest_triangles(flat, grid);
    const auto within = [&](int x, int y) {
      return x >= 0 && y >= 0 && x < grid.width && y < grid.height &&
             covered.covered(static_cast<std::size_t>(y) * grid.width + x);
    };
    const auto beside = [&](int x, int y) {
      for (int j = -kBeside; j <= kBeside; ++j) {
        for (int i = -kBeside; i <= kBeside; ++i) {
          if (i * i + j * j <= kBeside * kBeside && !within(x + i, y + j)) return true;
        }
      }
      return false;
    };
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        if (within(x, y) && beside(x, y))
          found.push_back(static_cast<std::size_t>(y) * grid.width + x);
      }
    }
  }
  Part part;
  part.kind = Part::Kind::points;
  part.points = Eigen::MatrixX3d::Zero(found.size(), 3);
  NamedArray colour{"colour", "1", NamedArray::On::points, Eigen::MatrixXd(found.size(), 3)};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const int x = static_cast<int>(found[i] % grid.width),
              y = static_cast<int>(found[i] / grid.width);
    part.points.row(i).head<2>() = grid.place(x, y).transpose();
    const PixelColour& c = image.at(x, y);
    colour.values.row(i) << c[0], c[1], c[2];
  }
  part.arrays.push_back(std::move(colour));
  return part;
}

TexturedFiles textured_files(const View& view, const PixelImage& photo, const OneViewResult& result,
                             const Pattern& pattern, const TexturedFileOptions& options) {
  const BakedPattern baked = bake_pattern(view, photo, result, pattern, options.bake);
  TexturedFiles made;
  made.files = {{kTextureFile, png_bytes(baked.image, 1 / baked.grid.pixel)},
                {"textured-pattern.svg", textured_svg(pattern, baked.grid)},
                {"model.obj", obj_text(result, pattern, baked.grid)},
                {"model.mtl", mtl_text()}};
  if (options.background) made.texels = border_texels(baked.image, baked.grid, pattern);
  made.diagnostics = {{"texture_seen", baked.seen},
                      {"texture_mirrored", baked.mirrored},
                      {"texture_flat", baked.flat},
                      {"texture_continued", baked.continued}};
  return made;
}

}  // namespace geoprior::sketch
