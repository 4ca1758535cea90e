#include "apps/sweep/report_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gatelight::apps {
namespace {

/// The plot in its picture of 580 by 370.
constexpr double kLeft = 64.0, kRight = 568.0, kTop = 28.0, kBottom = 318.0;

/// `low` and `high` lie at two coordinates of the picture.
struct Axis {
  double low, high, from, to;

  double at(double value) const { return from + (to - from) * std::log(value / low) / std::log(high / low); }
};

/// With room around the values; at least from one value to twice of it.
Axis axis_of(const std::vector<double>& values, double from, double to) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double room = std::max({std::sqrt(2.0 * *least / *most), std::pow(*most / *least, 0.05), 1.05});
  return {*least / room, *most * room, from, to};
}

/// The coarsest round numbers of which at least three are on the axis; seven powers of ten at most.
std::vector<double> ticks_of(const Axis& axis) {
  static const std::vector<double> kDigits[] = {
      {1.0}, {1.0, 2.0, 5.0}, {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}};
  const int first = static_cast<int>(std::floor(std::log10(axis.low)));
  const int last = static_cast<int>(std::floor(std::log10(axis.high)));
  const int step = 1 + (last - first) / 7;
  std::vector<double> ticks;
  for (const std::vector<double>& digits : kDigits) {
    ticks.clear();
    for (int i = 0; i <= (last - first) / step; ++i) {
      for (const double digit : digits) ticks.push_back(digit * std::pow(10.0, first + i * step));
    }
    std::erase_if(ticks, [&](double tick) { return tick < axis.low || tick > axis.high; });
    if (ticks.size() >= 3) break;
  }
  return ticks;
}

std::string grid_svg(const Axis& x, const Axis& y) {
  std::string svg;
  for (const double tick : ticks_of(x)) {
    svg += fmt::format(
        R"(<path d="M{0:.1f} {1}V{2}"/><text x="{0:.1f}" y="{3}" text-anchor="middle">{4:g}</text>)",
        x.at(tick), kTop, kBottom, kBottom + 20.0, tick);
  }
  for (const double tick : ticks_of(y)) {
    svg +=
        fmt::format(R"(<path d="M{0} {1:.1f}H{2}"/><text x="{3}" y="{4:.1f}" text-anchor="end">{5:g}</text>)",
                    kLeft, y.at(tick), kRight, kLeft - 8.0, y.at(tick) + 4.5, tick);
  }
  return "<g class=\"grid\">" + svg + "</g>\n";
}

/// Begins a group with the colour and the dashes of a line; report.css has the colours.
std::string group(const LineStyle& style) {
  static constexpr const char* kDashes[] = {"6 4", "2 3", "10 3 2 3"};
  return fmt::format(R"(<g class="line" style="color:var(--{});" stroke-dasharray="{}">)",
                     style.plain ? "plain" : fmt::format("s{}", 1 + style.index % 7),
                     style.plain ? kDashes[style.index % 3] : "none");
}

std::string marker(const LineStyle& style, double x, double y, const std::string& title) {
  static constexpr const char* kMarkers[] = {"M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z", "M-3.5-3.5h7v7h-7z",
                                             "M0-5l5 9h-10z", "M0-5.5l5.5 5.5-5.5 5.5-5.5-5.5z"};
  return fmt::format(
      "<path class=\"marker\" transform=\"translate({:.1f} {:.1f})\" d=\"{}\"><title>{}</title></path>\n", x,
      y, style.plain ? "M-4-4l8 8m0-8l-8 8" : kMarkers[style.index % 4], escaped(title));
}

std::string line_svg(const ChartLine& line, const Axis& x, const Axis& y) {
  std::string path, whiskers, markers;
  for (const ChartPoint& point : line.points) {
    const double u = x.at(point.x), v = y.at(point.y);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", u, v);
    whiskers += fmt::format("M{:.1f} {:.1f}V{:.1f}", u, y.at(point.low), y.at(point.high));
    markers += marker(line.style, u, v, point.title);
  }
  return fmt::format("{}<path d=\"{}\"/><path class=\"whisker\" d=\"{}\"/>\n{}</g>\n", group(line.style),
                     path, whiskers, markers);
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&' || c == '<' || c == '>' || c == '"') {
      safe += fmt::format("&#{};", static_cast<int>(c));
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string swatch_svg(const LineStyle& style) {
  return R"(<svg width="34" height="14" aria-hidden="true">)" + group(style) + "<path d=\"M0 7H34\"/>" +
         marker(style, 17.0, 7.0, "") + "</g></svg>";
}

std::string chart_svg(const std::string& x_title, const std::string& y_title,
                      const std::vector<ChartLine>& lines) {
  std::vector<double> xs, ys;
  for (const ChartLine& line : lines) {
    for (const ChartPoint& point : line.points) {
      xs.push_back(point.x);
      ys.insert(ys.end(), {point.low, point.high});
    }
  }
  const Axis x = axis_of(xs, kLeft, kRight), y = axis_of(ys, kBottom, kTop);
  std::string svg =
      fmt::format(R"(<svg class="chart" viewBox="0 0 580 370" role="img" aria-label="{} against {}">)",
                  escaped(y_title), escaped(x_title));
  svg += grid_svg(x, y);
  svg += fmt::format(R"(<text x="{}" y="16">{}</text>)", kLeft, escaped(y_title));
  svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="end">{}</text>)", kRight, kBottom + 44.0,
                     escaped(x_title));
  for (const ChartLine& line : lines) svg += line_svg(line, x, y);
  return svg + "</svg>\n";
}

}  // namespace gatelight::apps
