#pragma once

#include <string>
#include <vector>

namespace geoprior::sketch {

/// What a section of the hull is.
enum class HullSections {
  automatic,  ///< by what is drawn, see hull_sections.h
  box,        ///< all that the views see: a rectangle, where the third view does not cut it
  top,        ///< the outline of the top view, scaled to the widths of front and side at a height
};

/// What the sections of a hull are, and why.
struct SectionReport {
  bool from_top = false;     ///< all are the top view's outline, scaled
  std::string not_from_top;  ///< why not, of a drawing that has the view
  int openings = 0;          ///< drawn borders that end tubes, of all views
  /// Tubes of round sections.
  struct Tubes {
    int axis = 1;  ///< of space, orthogonal to which they are cut
    int count = 0;
    std::vector<std::string> rims;  ///< ids of their borders' strokes
    double least_exponent = 2, most_exponent = 2;
  };
  std::vector<Tubes> tubes;
  // Shares of the area of the closed hull; set once it is meshed.
  double top_share = 0, round_share = 0, box_share = 1;

  /// One sentence for a user, without shares.
  [[nodiscard]] std::string text() const;
};

}  // namespace geoprior::sketch
