#pragma once

#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {

struct PlotLine {
    std::string name;
    /// A CSS colour.
    std::string colour;
    std::vector<double> values{};
    bool isDashed = false;
    /// Where the values are; empty for the panel's own.
    std::vector<double> across{};
    bool hasPoints = false;
    bool hasLine = true;
};

/// A horizontal axis, logarithmic or from 0 on.
struct PlotAxis {
    std::string unit;
    /// Rising; the first and the last are the ends of the axis.
    std::vector<double> values;
    bool isLinear = false;

    bool operator==(const PlotAxis&) const = default;
};

/// One vertical axis and its lines.
struct PlotPanel {
    std::string axis;
    double lowest = 0.0;
    double highest = 1.0;
    double tick = 1.0;
    std::vector<PlotLine> lines;
    /// In pixels.
    double height = 240.0;
    /// Empty for frequency.
    std::optional<PlotAxis> across{};
};

/// An SVG picture of values over the logarithm of frequency, over time or over another quantity, with the panels below
/// each other. Each line has a value for each frequency; values that are not finite are skipped, values outside the
/// axis are drawn at its edge. Home-made: the build has no plotting library for C++, and a few kinds of panel are all
/// that is needed.
[[nodiscard]] std::string svgPlot(const std::string& title, const std::vector<double>& frequencyHz,
                                  const std::vector<PlotPanel>& panels);

}  // namespace haptoflow::cli
