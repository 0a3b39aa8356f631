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

/// One vertical axis and what is drawn over it.
struct PlotPanel {
    std::string axis;
    double lowest = 0.0;
    double highest = 1.0;
    double tick = 1.0;
    std::vector<PlotLine> lines;
};

/// An SVG picture of values over the logarithm of frequency, the panels one below the other. Each line has a value for
/// each frequency; what is not finite is left out, what lies beyond the axis is drawn at its edge.
[[nodiscard]] std::string svgPlot(const std::string& title, const std::vector<double>& frequencyHz,
                                  const std::vector<PlotPanel>& panels);

}  // namespace haptoflow::cli
