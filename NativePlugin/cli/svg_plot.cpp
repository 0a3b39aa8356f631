#include "svg_plot.hpp"

#include "model/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace haptoflow::cli {
namespace {

constexpr double pictureWidth = 760.0;
constexpr double plotLeft = 70.0;
constexpr double plotRight = 20.0;
constexpr double titleHeight = 34.0;
constexpr double legendHeight = 24.0;
constexpr double axisHeight = 44.0;
constexpr double panelGap = 18.0;
constexpr double pointRadius = 3.5;

/// Rounded to hundredths of a pixel; never "-0".
std::string svgNumber(double value) {
    return model::shortNumber(std::round(value * 100.0) / 100.0 + 0.0);
}

std::string svgEscaped(const std::string& text) {
    static const std::map<char, std::string> entities{{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
    std::string result;
    for (const char letter : text) {
        const auto entity = entities.find(letter);
        result += entity == entities.end() ? std::string(1, letter) : entity->second;
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

/// Maps values of a horizontal axis to positions.
class HorizontalAxis {
public:
    explicit HorizontalAxis(const PlotAxis& axis)
        : unit_(axis.unit), isLinear_(axis.isLinear), lowest_(axis.values.front()), highest_(axis.values.back()) {}

    [[nodiscard]] double at(double value) const {
        const double share = isLinear_ ? (value - lowest_) / (highest_ - lowest_)
                                       : std::log2(value / lowest_) / std::log2(highest_ / lowest_);
        return plotLeft + (pictureWidth - plotLeft - plotRight) * share;
    }

    [[nodiscard]] std::string draw(double top, double height, bool isNamed) const {
        std::string drawn;
        const auto mark = [&](double value, bool isLabelled) {
            if (value < lowest_ - 0.001 * std::abs(lowest_) || value > highest_ * 1.001) {
                return;
            }
            drawn +=
                svgLine(at(value), top, at(value), top + height, isLabelled ? "stroke=\"#ccc\"" : "stroke=\"#eee\"");
            if (isNamed && isLabelled) {
                drawn += svgText(at(value), top + height + 17.0, "middle", model::shortNumber(value));
            }
        };
        if (isLinear_) {
            // Five to ten steps.
            const double decade = std::pow(10.0, std::floor(std::log10(0.2 * (highest_ - lowest_))));
            const double steps = 0.2 * (highest_ - lowest_) / decade;
            const double step = decade * (steps < 2.0 ? 1.0 : steps < 5.0 ? 2.0 : 5.0);
            for (auto tick = std::llround(std::ceil(lowest_ / step)); tick <= std::llround(highest_ / step); ++tick) {
                mark(static_cast<double>(tick) * step, true);
            }
        } else {
            for (int decade = 0; decade < 6; ++decade) {
                for (int digit = 1; digit < 10; ++digit) {
                    mark(std::pow(10.0, decade) * digit, digit == 1 || digit == 2 || digit == 5);
                }
            }
        }
        return drawn + (isNamed ? svgText(plotLeft + (pictureWidth - plotLeft - plotRight) / 2.0, top + height + 36.0,
                                          "middle", unit_)
                                : "");
    }

private:
    std::string unit_;
    bool isLinear_;
    double lowest_;
    double highest_;
};

std::string svgPoint(double x, double y, const std::string& colour) {
    return "<circle cx=\"" + svgNumber(x) + "\" cy=\"" + svgNumber(y) + "\" r=\"" + svgNumber(pointRadius) +
           "\" fill=\"" + colour + "\"/>\n";
}

std::string drawPlotLine(const PlotLine& drawn, const std::vector<double>& panelAcross, const HorizontalAxis& axis,
                         const PlotPanel& panel, double top) {
    const std::vector<double>& across = drawn.across.empty() ? panelAcross : drawn.across;
    std::string path;
    std::string points;
    bool isDown = false;
    for (std::size_t i = 0; i < std::min(across.size(), drawn.values.size()); ++i) {
        if (!std::isfinite(drawn.values[i])) {
            isDown = false;
            continue;
        }
        const double share = std::clamp((drawn.values[i] - panel.lowest) / (panel.highest - panel.lowest), 0.0, 1.0);
        const double x = axis.at(across[i]);
        const double y = top + panel.height * (1.0 - share);
        path += (isDown ? " L" : " M") + svgNumber(x) + ' ' + svgNumber(y);
        points += drawn.hasPoints ? svgPoint(x, y, drawn.colour) : "";
        isDown = true;
    }
    if (!drawn.hasLine) {
        return points;
    }
    return "<path d=\"" + path + R"(" fill="none" stroke-width="2" stroke=")" + drawn.colour + "\"" +
           (drawn.isDashed ? " stroke-dasharray=\"6 4\"" : "") + "/>\n" + points;
}

std::string drawPlotPanel(const PlotPanel& panel, const PlotAxis& across, double top, bool isNamed) {
    const HorizontalAxis axis(across);
    std::string drawn = axis.draw(top, panel.height, isNamed);
    const auto lastTick = std::lround(std::floor((panel.highest + 1e-9) / panel.tick));
    for (auto tick = std::lround(std::ceil(panel.lowest / panel.tick)); tick <= lastTick; ++tick) {
        const double value = static_cast<double>(tick) * panel.tick;
        const double y = top + panel.height * (1.0 - (value - panel.lowest) / (panel.highest - panel.lowest));
        drawn += svgLine(plotLeft, y, pictureWidth - plotRight, y,
                         std::abs(value) < 1e-9 ? "stroke=\"#999\"" : "stroke=\"#ddd\"");
        drawn += svgText(plotLeft - 8.0, y + 4.0, "end", svgNumber(value));
    }
    const double middle = top + panel.height / 2.0;
    drawn += svgText(18.0, middle, "middle", panel.axis, " transform=\"rotate(-90 18 " + svgNumber(middle) + ")\"");
    double legend = plotLeft;
    for (const PlotLine& each : panel.lines) {
        drawn += drawPlotLine(each, across.values, axis, panel, top);
        if (each.hasLine) {
            drawn += svgLine(legend, top - 11.0, legend + 22.0, top - 11.0,
                             R"(stroke-width="2" stroke=")" + each.colour + "\"" +
                                 (each.isDashed ? " stroke-dasharray=\"6 4\"" : ""));
        }
        if (each.hasPoints) {
            drawn += svgPoint(legend + 11.0, top - 11.0, each.colour);
        }
        drawn += svgText(legend + 28.0, top - 7.0, "start", each.name);
        legend += 40.0 + 6.9 * static_cast<double>(each.name.size());
    }
    return drawn;
}

}  // namespace

std::string svgPlot(const std::string& title, const std::vector<double>& frequencyHz,
                    const std::vector<PlotPanel>& panels) {
    const PlotAxis frequency{.unit = "Hz", .values = frequencyHz};
    const auto across = [&](std::size_t index) { return panels[index].across.value_or(frequency); };
    const auto isNamed = [&](std::size_t index) {
        return index + 1 == panels.size() || across(index) != across(index + 1);
    };
    double height = titleHeight;
    std::vector<double> tops;
    for (std::size_t index = 0; index < panels.size(); ++index) {
        tops.push_back(height + legendHeight);
        height += legendHeight + panels[index].height + panelGap + (isNamed(index) ? axisHeight : 0.0);
    }
    std::string drawn = R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )" + svgNumber(pictureWidth) + ' ' +
                        svgNumber(height) + "\" width=\"" + svgNumber(pictureWidth) + "\" height=\"" +
                        svgNumber(height) +
                        "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\" role=\"img\">\n<title>" +
                        svgEscaped(title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
                        svgText(plotLeft, 22.0, "start", title, R"( font-size="15" font-weight="bold")");
    for (std::size_t index = 0; index < panels.size(); ++index) {
        drawn += drawPlotPanel(panels[index], across(index), tops[index], isNamed(index));
    }
    return drawn + "</svg>\n";
}

}  // namespace haptoflow::cli
