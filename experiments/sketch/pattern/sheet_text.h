#pragma once

#include <string>
#include <string_view>

namespace geoprior::sketch {

/// Text of strangers made fit for a label: code points that can be seen, one line, not too long.
///
/// Control characters and line ends become spaces, what is no UTF-8, no character or turns the
/// direction of writing becomes U+FFFD, and what is longer than `most` ends in "...".
///
/// @param utf8  any bytes
/// @param most  code points, at least 3
std::u32string label_text(std::string_view utf8, std::size_t most);

/// Width of text set in Helvetica, in units of its size; characters outside ASCII are taken to be
/// as wide as a capital, those from U+1100 on as wide as high.
///
/// Source: Adobe 1997, font metrics of the 14 standard fonts.
double helvetica_width(std::u32string_view text);

}  // namespace geoprior::sketch
