#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace geoprior {

using Rgb = std::array<std::uint8_t, 3>;

/// A picture of 8-bit colour, rows from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<Rgb> pixels;

  Picture() = default;
  Picture(int w, int h, Rgb fill = {255, 255, 255})
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, fill) {}

  [[nodiscard]] Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  [[nodiscard]] const Rgb& at(int x, int y) const { return const_cast<Picture*>(this)->at(x, y); }

  /// Copies `other` with its top left corner at (x, y); what lies outside is dropped.
  void paste(const Picture& other, int x, int y);
  /// Mixes `color` into one pixel; outside is dropped.
  void blend(int x, int y, Rgb color, double opacity);
  void fill_rectangle(int x, int y, int w, int h, Rgb color);
};

/// Writes a PNG of best compression as temporary + rename; throws Error naming the file.
void write_png(const Picture& picture, const std::filesystem::path& file);

struct TextStyle {
  int size_px = 24;
  Rgb color{30, 30, 30};
  bool bold = false;
  bool vertical = false;  ///< reads upwards
};

enum class Align { left, center, right };

/// Width in pixels of a text (UTF-8).
int text_width(const std::string& text, const TextStyle& style);

/// Draws one line of text; (x, baseline) is the start, centre or end of its base line. Vertical
/// text reads upwards, with the base line at x.
void draw_text(Picture& picture, const std::string& text, int x, int baseline, Align align,
               const TextStyle& style);

}  // namespace geoprior
