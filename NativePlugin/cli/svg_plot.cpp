#include "svg_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>

namespace haptoflow::cli {
namespace {

constexpr double pictureWidth = 760.0;
constexpr double plotLeft = 70.0;
constexpr double plotRight = 20.0;
constexpr double titleHeight = 34.0;
constexpr double panelHeight = 240.0;
constexpr double legendHeight = 24.0;
constexpr double axisHeight = 44.0;
constexpr double panelSpace = legendHeight + panelHeight + 18.0;

std::string svgNumber(double value) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(6);
    // Rounded to hundredths of a pixel; never "-0".
    stream << std::round(value * 100.0) / 100.0 + 0.0;
    return stream.str();
}

std::string svgEscaped(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        switch (letter) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += letter;
        }
    }
    return result;
}

std::string svgText(double x, double y, const std::string& anchor, const std::string& content,
                    const std::string& more = "") {
    return "<text x=\"" + svgNumber(x) + "\" y=\"" + svgNumber(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
           svgEscaped(content) + "</text>\n";
}

std::string svgLine(double x1, double y1, double x2, double y2, const std::string& style) {
    return "<line x1=\"" + svgNumber(x1) + "\" y1=\"" + svgNumber(y1) + "\" x2=\"" + svgNumber(x2) + "\" y2=\"" +
           svgNumber(y2) + "\" " + style + "/>\n";
}

/// Maps frequencies to horizontal positions.
class FrequencyAxis {
public:
    FrequencyAxis(double lowestHz, double highestHz) : lowestHz_(lowestHz), octaves_(std::log2(highestHz / lowestHz)) {}

    [[nodiscard]] double at(double hz) const {
        return plotLeft + (pictureWidth - plotLeft - plotRight) * std::log2(hz / lowestHz_) / octaves_;
    }

    [[nodiscard]] std::string draw(double top, double height, bool isNamed) const {
        std::string drawn;
        for (double decade = 1.0; decade < 1e6; decade *= 10.0) {
            for (int digit = 1; digit < 10; ++digit) {
                const double hz = decade * digit;
                if (hz < lowestHz_ * 0.999 || hz > lowestHz_ * std::exp2(octaves_) * 1.001) {
                    continue;
                }
                const bool isLabelled = digit == 1 || digit == 2 || digit == 5;
                drawn += svgLine(at(hz), top, at(hz), top + height, isLabelled ? "stroke=\"#ccc\"" : "stroke=\"#eee\"");
                if (isNamed && isLabelled) {
                    drawn += svgText(at(hz), top + height + 17.0, "middle", svgNumber(hz));
                }
            }
        }
        return drawn + (isNamed ? svgText(plotLeft + (pictureWidth - plotLeft - plotRight) / 2.0, top + height + 36.0,
                                          "middle", "Hz")
                                : "");
    }

private:
    double lowestHz_;
    double octaves_;
};

std::string drawPlotLine(const PlotLine& drawn, const std::vector<double>& frequencyHz, const FrequencyAxis& axis,
                         const PlotPanel& panel, double top) {
    std::string path;
    bool isDown = false;
    for (std::size_t i = 0; i < std::min(frequencyHz.size(), drawn.values.size()); ++i) {
        if (!std::isfinite(drawn.values[i])) {
            isDown = false;
            continue;
        }
        const double share = std::clamp((drawn.values[i] - panel.lowest) / (panel.highest - panel.lowest), 0.0, 1.0);
        path += (isDown ? " L" : " M") + svgNumber(axis.at(frequencyHz[i])) + ' ' +
                svgNumber(top + panelHeight * (1.0 - share));
        isDown = true;
    }
    return "<path d=\"" + path + "\" fill=\"none\" stroke-width=\"2\" stroke=\"" + drawn.colour + "\"" +
           (drawn.isDashed ? " stroke-dasharray=\"6 4\"" : "") + "/>\n";
}

std::string drawPlotPanel(const PlotPanel& panel, const std::vector<double>& frequencyHz, const FrequencyAxis& axis,
                          double top, bool isLast) {
    std::string drawn = axis.draw(top, panelHeight, isLast);
    for (double value = std::ceil(panel.lowest / panel.tick) * panel.tick; value <= panel.highest + 1e-9;
         value += panel.tick) {
        const double y = top + panelHeight * (1.0 - (value - panel.lowest) / (panel.highest - panel.lowest));
        drawn += svgLine(plotLeft, y, pictureWidth - plotRight, y,
                         std::abs(value) < 1e-9 ? "stroke=\"#999\"" : "stroke=\"#ddd\"");
        drawn += svgText(plotLeft - 8.0, y + 4.0, "end", svgNumber(value));
    }
    const double middle = top + panelHeight / 2.0;
    drawn += svgText(18.0, middle, "middle", panel.axis, " transform=\"rotate(-90 18 " + svgNumber(middle) + ")\"");
    double legend = plotLeft;
    for (const PlotLine& each : panel.lines) {
        drawn += drawPlotLine(each, frequencyHz, axis, panel, top);
        drawn += svgLine(
            legend, top - 11.0, legend + 22.0, top - 11.0,
            "stroke-width=\"2\" stroke=\"" + each.colour + "\"" + (each.isDashed ? " stroke-dasharray=\"6 4\"" : ""));
        drawn += svgText(legend + 28.0, top - 7.0, "start", each.name);
        legend += 48.0 + 7.2 * static_cast<double>(each.name.size());
    }
    return drawn;
}

}  // namespace

std::string svgPlot(const std::string& title, const std::vector<double>& frequencyHz,
                    const std::vector<PlotPanel>& panels) {
    const double height = titleHeight + panelSpace * static_cast<double>(panels.size()) + axisHeight;
    const FrequencyAxis axis(frequencyHz.front(), frequencyHz.back());
    std::string drawn = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + svgNumber(pictureWidth) + ' ' +
                        svgNumber(height) + "\" width=\"" + svgNumber(pictureWidth) + "\" height=\"" +
                        svgNumber(height) +
                        "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\" role=\"img\">\n<title>" +
                        svgEscaped(title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
                        svgText(plotLeft, 22.0, "start", title, " font-size=\"15\" font-weight=\"bold\"");
    for (std::size_t index = 0; index < panels.size(); ++index) {
        const double top = titleHeight + legendHeight + panelSpace * static_cast<double>(index);
        drawn += drawPlotPanel(panels[index], frequencyHz, axis, top, index + 1 == panels.size());
    }
    return drawn + "</svg>\n";
}

}  // namespace haptoflow::cli
