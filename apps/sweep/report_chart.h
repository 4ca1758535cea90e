#pragma once
// Charts with two logarithmic axes, as SVG.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::apps {

/// Text for HTML and SVG, in elements and in quoted attributes.
std::string escaped(std::string_view text);

/// How a line looks: those with a cache have colours, those without are grey and dashed.
struct LineStyle {
  std::size_t index = 0;  ///< among the lines of its kind
  bool plain = false;
};

/// The line's look for a legend.
std::string swatch_svg(const LineStyle& style);

/// All numbers are above zero. A whisker reaches from low to high; the title is shown under the mouse.
struct ChartPoint {
  double x = 0.0, y = 0.0, low = 0.0, high = 0.0;
  std::string title;
};

struct ChartLine {
  LineStyle style;
  std::vector<ChartPoint> points;  ///< in the order of the line
};

/// At least one point.
std::string chart_svg(const std::string& x_title, const std::string& y_title,
                      const std::vector<ChartLine>& lines);

}  // namespace gatelight::apps
