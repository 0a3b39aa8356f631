#include "effects/wave_features.hpp"
#include "headless/command_files.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"
#include "render_output.hpp"
#include "svg_plot.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::cli {
namespace {

using clips::ClipPoint;
using clips::HapticClip;

std::pair<double, double> rangeOf(const std::vector<ClipPoint>& points) {
    if (points.empty()) {
        return {};
    }
    const auto [lowest, highest] = std::ranges::minmax_element(points, {}, &ClipPoint::value);
    return {lowest->value, highest->value};
}

/// Draws the amplitude over time as a row of blocks. Each is as high as the largest amplitude of its stretch of time.
std::string amplitudeRow(const HapticClip& clip, std::size_t columns) {
    static constexpr std::array<const char*, 9> blocks{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    constexpr int readsPerColumn = 16;
    clips::CurveReader amplitude(clip.amplitude, 0.0);
    std::string row;
    for (std::size_t column = 0; column < columns; ++column) {
        const auto timeOf = [&](double place) {
            return clip.durationSeconds * (static_cast<double>(column) + place) / static_cast<double>(columns);
        };
        double largest = 0.0;
        for (int i = 0; i < readsPerColumn; ++i) {
            largest = std::max(largest, amplitude.at(timeOf((i + 0.5) / readsPerColumn)));
        }
        for (const clips::ClipTransient& transient : clip.transients) {
            if (transient.seconds >= timeOf(0.0) && transient.seconds < timeOf(1.0)) {
                largest = std::max(largest, transient.amplitude);
            }
        }
        row += blocks[static_cast<std::size_t>(std::ceil(std::clamp(largest, 0.0, 1.0) * 8.0))];
    }
    return row;
}

std::string pictureOf(const HapticClip& clip, const std::string& title) {
    const auto lineOf = [&clip](std::string name, std::string colour, const std::vector<ClipPoint>& points) {
        PlotLine line{.name = std::move(name), .colour = std::move(colour)};
        for (const ClipPoint& point : points) {
            line.across.push_back(point.seconds);
            line.values.push_back(point.value);
        }
        if (!points.empty()) {
            line.across.push_back(clip.durationSeconds);
            line.values.push_back(points.back().value);
        }
        return line;
    };
    PlotLine taps{.name = "transients", .colour = "#c0392b", .hasPoints = true, .hasLine = false};
    PlotLine tapFrequencies = taps;
    for (const clips::ClipTransient& transient : clip.transients) {
        for (PlotLine* line : {&taps, &tapFrequencies}) {
            line->across.push_back(transient.seconds);
        }
        taps.values.push_back(transient.amplitude);
        tapFrequencies.values.push_back(transient.frequencyHz);
    }
    const PlotAxis time{.unit = "s", .values = {0.0, std::max(0.001, clip.durationSeconds)}, .isLinear = true};
    PlotPanel amplitude{.axis = "share of the device's range",
                        .lowest = 0.0,
                        .highest = 1.0,
                        .tick = 0.25,
                        .lines = {lineOf("amplitude", "#1f6f8b", clip.amplitude)},
                        .across = time};
    PlotPanel frequency{.axis = "Hz",
                        .lowest = 0.0,
                        .highest = 400.0,
                        .tick = 100.0,
                        .lines = {lineOf("frequency", "#7a9e3f", clip.frequencyHz)},
                        .height = 160.0,
                        .across = time};
    if (!clip.transients.empty()) {
        amplitude.lines.push_back(std::move(taps));
        frequency.lines.push_back(std::move(tapFrequencies));
    }
    return svgPlot(title, {}, {amplitude, frequency});
}

}  // namespace

void inspectClip(const std::string& path, bool asJson, const std::string& picturePath) {
    const std::string text = headless::readInputFile("the clip", path, "a clip (.haptic, .ahap or .hjif)");
    clips::ReadClip read;
    try {
        read = clips::readClip(text);
    } catch (const clips::ClipError& error) {
        throw InputError(path + ": " + error.what());
    }
    const HapticClip& clip = read.clip;
    const OptionalOutput picture = optionalOutput("--picture", picturePath);
    writeText(picture, pictureOf(clip, clip.origin.title.empty() ? path : clip.origin.title));
    commit(picture);
    const auto [lowestHz, highestHz] = rangeOf(clip.frequencyHz);
    const double loudest = rangeOf(clip.amplitude).second;
    const effects::IntensityErrors motor = motorErrors(clips::waveOf(clip, effects::WaveFeatures::sampleRateHz));
    if (asJson) {
        const nlohmann::ordered_json report{
            {"file", path},
            {"format", clips::endingOf(read.format)},
            {"title", clip.origin.title},
            {"description", clip.origin.description},
            {"editor", clip.origin.editor},
            {"seconds", clip.durationSeconds},
            {"amplitude_points", clip.amplitude.size()},
            {"frequency_points", clip.frequencyHz.size()},
            {"transients", clip.transients.size()},
            {"largest_amplitude", loudest},
            {"frequency_hz", {lowestHz, highestHz}},
            {"omitted", read.omitted},
            {"motor_160_hz_intensity_error_db", {{"mean", motor.meanDb}, {"p95", motor.percentile95Db}}}};
        std::cout << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
        return;
    }
    const auto orDash = [](const std::string& words) { return words.empty() ? "-" : words; };
    constexpr std::size_t columns = 64;
    std::cout << '|' << amplitudeRow(clip, columns) << "|\n\n";
    const std::vector<std::pair<std::string, std::string>> rows{
        {"format", '.' + std::string(clips::endingOf(read.format))},
        {"title", orDash(clip.origin.title)},
        {"description", orDash(clip.origin.description)},
        {"written by", orDash(clip.origin.editor)},
        {"duration", fixedDecimals(clip.durationSeconds, 3) + " s"},
        {"points", std::to_string(clip.amplitude.size()) + " of amplitude, " + std::to_string(clip.frequencyHz.size()) +
                       " of frequency"},
        {"transients", std::to_string(clip.transients.size())},
        {"largest amplitude", fixedDecimals(100.0 * loudest, 0) + " % of the device's range"},
        {"frequency", clip.frequencyHz.empty() ? "left to the device"
                                               : model::shortNumber(std::round(lowestHz)) + " to " +
                                                     model::shortNumber(std::round(highestHz)) + " Hz"},
        {"a motor of 160 Hz", motor.feltFrames == 0 ? "plays nothing that is felt"
                                                    : "plays it within " + fixedDecimals(motor.percentile95Db, 1) +
                                                          " dB of perceived intensity in 95 % of what is felt"},
        {"not read", orDash(clips::omittedText(read))}};
    for (const auto& [name, value] : rows) {
        std::cout << "  " << name << std::string(19 - name.size(), ' ') << value << '\n';
    }
}

}  // namespace haptoflow::cli
