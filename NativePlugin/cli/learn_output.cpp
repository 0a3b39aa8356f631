#include "learn_output.hpp"

#include "messages.hpp"
#include "model/plain_text.hpp"
#include "svg_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace haptoflow::cli {
namespace {

using learning::ForceComparison;
using learning::LearningReport;
using learning::SpeedComparison;

constexpr const char* recordedColour = "#222222";
constexpr const char* learntColour = "#1f77b4";
constexpr const char* labelColour = "#a0a0a0";
constexpr double smallHeight = 150.0;
/// Fewer say more about chance than about the material.
constexpr std::size_t fewestFrames = 8;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> millimetres(const std::vector<double>& mps) {
    std::vector<double> result(mps.size());
    std::ranges::transform(mps, result.begin(), [](double each) { return 1000.0 * each; });
    return result;
}

PlotAxis speedAxis(const LearningReport& report) {
    return {.unit = "mm/s", .values = millimetres(report.lawSpeedsMps)};
}

std::string nearest(const LearningReport& report) {
    return "nearest label, " + report.nearestLabel;
}

double decibels(double mps2) {
    return mps2 > 0.0 ? 20.0 * std::log10(mps2) : nothing;
}

PlotPanel spectrumPanel(const LearningReport& report, const SpeedComparison& comparison) {
    constexpr double shownDb = 50.0;
    double highest = -200.0;
    for (const auto* curve : {&comparison.recorded, &comparison.learnt, &comparison.nearestLabel}) {
        for (const double value : curve->decibels) {
            highest = std::max(highest, value);
        }
    }
    highest = 10.0 * std::ceil(highest / 10.0);
    const auto named = [](const std::string& what, const SpeedComparison::Curve& curve) {
        return what + ", " + fixedDecimals(curve.rmsMps2, 2) + " m/s^2";
    };
    return {.axis = "dB at " + inMillimetres(comparison.speedMps) + " mm/s",
            .lowest = highest - shownDb,
            .highest = highest,
            .tick = 10.0,
            .lines = {{named(nearest(report), comparison.nearestLabel), labelColour, comparison.nearestLabel.decibels},
                      {named("recorded, " + fixedDecimals(comparison.seconds, 1) + " s", comparison.recorded),
                       recordedColour, comparison.recorded.decibels},
                      {named("learnt", comparison.learnt), learntColour, comparison.learnt.decibels}}};
}

/// The material's law where it was recorded, and where it was not. The two meet.
std::array<std::vector<double>, 2> dividedLaw(const LearningReport& report, const ForceComparison& force) {
    const std::size_t count = report.lawSpeedsMps.size();
    std::vector<double> within(count, nothing);
    std::vector<double> beyond(count, nothing);
    const auto isWithin = [&](std::size_t i) {
        return report.lawSpeedsMps[i] >= force.recordedMps[0] && report.lawSpeedsMps[i] <= force.recordedMps[1];
    };
    for (std::size_t i = 0; i < count; ++i) {
        const double level = decibels(force.learntMps2[i]);
        const bool isEnd = isWithin(i) && ((i > 0 && !isWithin(i - 1)) || (i + 1 < count && !isWithin(i + 1)));
        (isWithin(i) ? within : beyond)[i] = level;
        if (isEnd) {
            beyond[i] = level;
        }
    }
    return {within, beyond};
}

/// Levels over speed at one force. `ends`: of the vertical axis, in dB.
PlotPanel levelPanel(const LearningReport& report, const ForceComparison& force, std::array<double, 2> ends) {
    PlotLine recorded{
        "recorded " + inMillimetres(force.recordedMps[0]) + " to " + inMillimetres(force.recordedMps[1]) + " mm/s",
        recordedColour,
        {}};
    recorded.hasPoints = true;
    recorded.hasLine = false;
    for (const ForceComparison::AtSpeed& each : force.speeds) {
        if (each.recorded.frames >= fewestFrames) {
            recorded.across.push_back(1000.0 * each.speedMps);
            recorded.values.push_back(decibels(each.recorded.rmsMps2));
        }
    }
    std::vector<double> label(force.nearestLabelMps2.size());
    std::ranges::transform(force.nearestLabelMps2, label.begin(), decibels);
    const auto [within, beyond] = dividedLaw(report, force);
    return {.axis = "dB re 1 m/s^2, " + fixedDecimals(force.forceNewtons, 1) + " N",
            .lowest = ends[0],
            .highest = ends[1],
            .tick = 10.0,
            .lines = {{nearest(report), labelColour, label},
                      {"learnt", learntColour, within},
                      {"extrapolated", learntColour, beyond, true},
                      recorded},
            .height = smallHeight + 30.0,
            .across = speedAxis(report)};
}

std::array<double, 2> levelEnds(const LearningReport& report) {
    double lowest = 200.0;
    double highest = -200.0;
    for (const ForceComparison& force : report.forces) {
        for (const auto* levels : {&force.learntMps2, &force.nearestLabelMps2}) {
            for (const double level : *levels) {
                lowest = std::isfinite(decibels(level)) ? std::min(lowest, decibels(level)) : lowest;
                highest = std::isfinite(decibels(level)) ? std::max(highest, decibels(level)) : highest;
            }
        }
    }
    return {10.0 * std::floor(lowest / 10.0), 10.0 * std::ceil(highest / 10.0 + 0.01)};
}

/// A panel of one figure of recording, material and nearest label over speed.
template <typename Figure>
PlotPanel figurePanel(const LearningReport& report, const std::string& axis, Figure figure) {
    const auto line = [&](const std::string& words, const char* colour,
                          SpeedComparison::Curve SpeedComparison::*curve) {
        PlotLine drawn{words, colour, {}};
        drawn.hasPoints = true;
        for (const SpeedComparison& each : report.comparisons) {
            const learning::WaveFigures& figures = (each.*curve).figures;
            drawn.across.push_back(1000.0 * each.speedMps);
            drawn.values.push_back(figures.frames >= fewestFrames ? figure(figures).value_or(nothing) : nothing);
        }
        return drawn;
    };
    return {.axis = axis,
            .lines = {line(nearest(report), labelColour, &SpeedComparison::nearestLabel),
                      line("recorded", recordedColour, &SpeedComparison::recorded),
                      line("learnt", learntColour, &SpeedComparison::learnt)},
            .height = smallHeight,
            .across = speedAxis(report)};
}

PlotPanel kurtosisPanel(const LearningReport& report) {
    PlotPanel panel =
        figurePanel(report, "kurtosis", [](const learning::WaveFigures& figures) { return figures.kurtosis; });
    panel.highest = 6.0;
    for (const PlotLine& line : panel.lines) {
        for (const double value : line.values) {
            panel.highest = std::isfinite(value) ? std::max(panel.highest, std::ceil(value)) : panel.highest;
        }
    }
    panel.tick = std::ceil(panel.highest / 6.0);
    return panel;
}

PlotPanel ribPanel(const LearningReport& report, std::size_t rib) {
    const learning::WaveVector& vector = report.waveVectors[rib];
    PlotPanel panel =
        figurePanel(report, "ribs of " + fixedDecimals(1.0 / std::hypot(vector.x, vector.y), 2) + " mm, dB",
                    [rib](const learning::WaveFigures& figures) { return figures.ribsDb[rib]; });
    panel.lowest = -40.0;
    panel.highest = 0.0;
    panel.tick = 10.0;
    return panel;
}

}  // namespace

std::string learningPicture(const LearningReport& report, const std::string& name) {
    std::vector<PlotPanel> panels;
    for (const SpeedComparison& each : report.comparisons) {
        panels.push_back(spectrumPanel(report, each));
    }
    for (const ForceComparison& each : report.forces) {
        panels.push_back(levelPanel(report, each, levelEnds(report)));
    }
    if (!report.comparisons.empty()) {
        panels.push_back(kurtosisPanel(report));
        for (std::size_t rib = 0; rib < report.waveVectors.size(); ++rib) {
            panels.push_back(ribPanel(report, rib));
        }
    }
    return svgPlot(name + ": recorded and learnt; spectra in dB re 1 (m/s^2)^2 / Hz", report.comparedHz, panels);
}

namespace {

/// The characters that some platform's file names may not hold, or that lead to another folder.
constexpr std::string_view forbidden = R"(/\:*?"<>|)";

}  // namespace

std::string fileNameOf(std::string_view words) {
    constexpr std::size_t maximumBytes = 128;
    std::string name;
    for (const char letter : model::shortened(words, maximumBytes)) {
        const bool isPlain =
            !model::hasControlCharacter({&letter, 1}) && forbidden.find(letter) == std::string_view::npos;
        name += isPlain ? letter : '-';
    }
    const std::size_t first = name.find_first_not_of(" .-");
    return first == std::string::npos ? "material" : name.substr(first, name.find_last_not_of(" .-") - first + 1);
}

}  // namespace haptoflow::cli
