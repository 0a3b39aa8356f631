#pragma once

#include <string>
#include <vector>

namespace haptoflow::cli {

struct PlotLine {
    std::string name;
    /// A CSS colour.
    std::string colour;
    std::vector<double> values;
    bool isDashed = false;
};

/// One vertical axis and its lines.
struct PlotPanel {
    std::string axis;
    double lowest = 0.0;
    double highest = 1.0;
    double tick = 1.0;
    std::vector<PlotLine> lines;
};

/// An SVG picture of values over the logarithm of frequency, with the panels below each other. Each line has a value
/// for each frequency; values that are not finite are skipped, values outside the axis are drawn at its edge.
/// Home-made: the build has no plotting library for C++, and two kinds of panel are all that is needed.
[[nodiscard]] std::string svgPlot(const std::string& title, const std::vector<double>& frequencyHz,
                                  const std::vector<PlotPanel>& panels);

}  // namespace haptoflow::cli
