#include "testbed/view/figure/picture.h"

#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkTextProperty.h>
#include <vtkUnicodeString.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"

namespace geoprior {
namespace {

constexpr int kDpi = 72;  // a font size is then in pixels

void apply(const TextStyle& style, vtkTextProperty* property) {
  // The font of the plots, a dependency of Debian's matplotlib; VTK's own has no degree sign.
  const std::string file = style.bold ? "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
                                      : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  property->SetFontFamilyToArial();
  if (std::filesystem::exists(file)) {
    property->SetFontFamily(VTK_FONT_FILE);
    property->SetFontFile(file.c_str());
  }
  property->SetFontSize(style.size_px);
  property->SetOrientation(style.vertical ? 90 : 0);
  property->SetColor(style.color[0] / 255.0, style.color[1] / 255.0, style.color[2] / 255.0);
}

// VTK 9.1 drops every character outside ASCII from a std::string; the overloads that do not are
// marked deprecated in favour of it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
std::array<int, 4> text_box(vtkTextProperty* property, const std::string& text) {
  std::array<int, 4> box{};
  vtkFreeTypeTools::GetInstance()->GetBoundingBox(property, vtkUnicodeString::from_utf8(text), kDpi,
                                                  box.data());
  return box;
}

bool text_image(vtkTextProperty* property, const std::string& text, vtkImageData* image) {
  std::array<int, 2> size{};
  vtkFreeTypeTools* tools = vtkFreeTypeTools::GetInstance();
  tools->ScaleToPowerTwoOff();
  return tools->RenderString(property, vtkUnicodeString::from_utf8(text), kDpi, image, size.data());
}
#pragma GCC diagnostic pop

}  // namespace

void Picture::paste(const Picture& other, int x, int y) {
  for (int row = std::max(0, -y); row < other.height && y + row < height; ++row) {
    for (int column = std::max(0, -x); column < other.width && x + column < width; ++column) {
      at(x + column, y + row) = other.at(column, row);
    }
  }
}

void Picture::blend(int x, int y, Rgb color, double opacity) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  Rgb& pixel = at(x, y);
  for (std::size_t c = 0; c < 3; ++c) {
    const double mixed = pixel[c] + (color[c] - pixel[c]) * opacity;
    pixel[c] = static_cast<std::uint8_t>(std::lround(std::clamp(mixed, 0.0, 255.0)));
  }
}

void Picture::fill_rectangle(int x, int y, int w, int h, Rgb color) {
  for (int row = std::max(0, y); row < std::min(height, y + h); ++row) {
    for (int column = std::max(0, x); column < std::min(width, x + w); ++column) {
      at(column, row) = color;
    }
  }
}

void write_png(const Picture& picture, const std::filesystem::path& file) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* bytes = static_cast<unsigned char*>(image->GetScalarPointer());
  for (int y = picture.height - 1; y >= 0; --y) {  // VTK's rows start at the bottom
    for (int x = 0; x < picture.width; ++x) {
      for (const std::uint8_t channel : picture.at(x, y)) *bytes++ = channel;
    }
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->SetCompressionLevel(9);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* png = writer->GetResult();
  if (png == nullptr || png->GetNumberOfValues() == 0) {
    throw Error("the picture could not be encoded", file.string());
  }
  write_file_atomically(file, std::string_view(reinterpret_cast<const char*>(png->GetPointer(0)),
                                               static_cast<std::size_t>(png->GetNumberOfValues())));
}

int text_width(const std::string& text, const TextStyle& style) {
  vtkNew<vtkTextProperty> property;
  apply(style, property);
  property->SetOrientation(0);
  const std::array<int, 4> box = text_box(property, text);
  return box[1] - box[0] + 1;
}

void draw_text(Picture& picture, const std::string& text, int x, int baseline, Align align,
               const TextStyle& style) {
  if (text.empty()) return;
  vtkNew<vtkTextProperty> property;
  apply(style, property);
  vtkNew<vtkImageData> image;
  if (!text_image(property, text, image)) {
    throw Error("text could not be drawn", "'" + text + "'");
  }
  const int length = text_width(text, style);
  const int shift = align == Align::left ? 0 : align == Align::center ? length / 2 : length;
  const int x0 = style.vertical ? x : x - shift;
  const int y0 = style.vertical ? baseline + shift : baseline;
  const int* extent = image->GetExtent();
  for (int row = extent[2]; row <= extent[3]; ++row) {
    for (int column = extent[0]; column <= extent[1]; ++column) {
      const auto* rgba = static_cast<unsigned char*>(image->GetScalarPointer(column, row, 0));
      picture.blend(x0 + column, y0 - row, style.color, rgba[3] / 255.0);
    }
  }
}

}  // namespace geoprior
