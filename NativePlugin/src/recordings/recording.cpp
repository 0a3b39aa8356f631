#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace haptoflow::recordings {
namespace {

constexpr double maximumLostShare = 0.5;
/// A clipped wave stays at its extreme value while it would exceed it; noise reaches its maximum only once.
constexpr std::size_t minimumClippedRun = 4;

void require(bool holds, const std::string& message) {
    if (!holds) {
        throw std::invalid_argument(message);
    }
}

/// A longer run of samples that are not finite, with others before and after it, is a pause and not damage.
constexpr double minimumPauseSeconds = 0.25;

struct AxisFigures {
    std::size_t finite = 0;
    /// Samples outside pauses.
    std::size_t recorded = 0;
    double mean = 0.0;
    double rms = 0.0;
};

AxisFigures figuresOf(const Recording& recording, std::size_t axis) {
    AxisFigures figures;
    double sum = 0.0;
    double squares = 0.0;
    const auto at = [&](std::size_t i) { return recording.accelerationMps2[i * recording.axisCount + axis]; };
    const std::size_t count = recording.sampleCount();
    const auto longestLoss = static_cast<std::size_t>(minimumPauseSeconds * recording.rateHz);
    std::size_t lost = 0;
    figures.recorded = count;
    for (std::size_t i = 0; i < count; ++i) {
        const float value = at(i);
        if (!std::isfinite(value)) {
            ++lost;
        } else {
            figures.recorded -= lost > longestLoss && figures.finite > 0 ? lost : 0;
            lost = 0;
            sum += value;
            ++figures.finite;
        }
    }
    if (figures.finite == 0) {
        return figures;
    }
    figures.mean = sum / static_cast<double>(figures.finite);
    for (std::size_t i = 0; i < count; ++i) {
        const float value = at(i);
        if (std::isfinite(value)) {
            squares += (value - figures.mean) * (value - figures.mean);
        }
    }
    figures.rms = std::sqrt(squares / static_cast<double>(figures.finite));
    return figures;
}

}  // namespace

double speedAt(const Recording& recording, std::size_t sample) {
    return recording.velocityMps.empty()
               ? std::hypot(recording.constantVelocityMps[0], recording.constantVelocityMps[1])
               : std::hypot(static_cast<double>(recording.velocityMps[2 * sample]),
                            static_cast<double>(recording.velocityMps[2 * sample + 1]));
}

double squaredSteps(const Recording& recording, std::size_t first, std::size_t count) {
    double squares = 0.0;
    for (std::size_t i = first; i < first + count; ++i) {
        for (std::size_t axis = 0; axis < recording.axisCount; ++axis) {
            const double step = static_cast<double>(recording.accelerationMps2[i * recording.axisCount + axis]) -
                                recording.accelerationMps2[(i - 1) * recording.axisCount + axis];
            squares += step * step;
        }
    }
    return squares;
}

double clippedShare(std::span<const float> values, std::size_t stride) {
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    std::size_t finite = 0;
    for (std::size_t i = 0; i < values.size(); i += stride) {
        if (std::isfinite(values[i])) {
            lowest = std::min(lowest, values[i]);
            highest = std::max(highest, values[i]);
            ++finite;
        }
    }
    if (!(highest > lowest)) {
        return 0.0;
    }
    std::size_t run = 0;
    std::size_t clipped = 0;
    for (std::size_t i = 0; i < values.size(); i += stride) {
        const bool isEnd = values[i] == lowest || values[i] == highest;
        run = isEnd && run > 0 && values[i] == values[i - stride] ? run + 1 : (isEnd ? 1 : 0);
        clipped += run == minimumClippedRun ? minimumClippedRun : (run > minimumClippedRun ? 1 : 0);
    }
    return static_cast<double>(clipped) / static_cast<double>(finite);
}

double quantile(std::vector<double> values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

double upperMedian(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

void fail(const std::string& place, const std::string& found, const std::string& expected) {
    throw RecordingUnusable(place + ": " + found + "; expected " + expected);
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : ", ") + word;
    }
    return text;
}

std::string plainNumber(double value) {
    constexpr double beyondDigits = 1000.0;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(3);
    if (std::abs(value) >= beyondDigits) {
        text.precision(0);
        text << std::fixed;
    }
    text << value;
    return text.str();
}

void checkSizes(const Recording& recording) {
    require(recording.axisCount == 1 || recording.axisCount == 3,
            "the recording has " + std::to_string(recording.axisCount) + " axes; expected 1 or 3");
    require(recording.rateHz >= lowestRateHz && recording.rateHz <= highestRateHz,
            "the recording's rate is " + plainNumber(recording.rateHz) + " Hz; expected 1000 to 192000 Hz");
    const std::size_t count = recording.sampleCount();
    require(count * recording.axisCount == recording.accelerationMps2.size(),
            "the acceleration does not have the same number of samples for each axis");
    require(recording.velocityMps.empty() || recording.velocityMps.size() == 2 * count,
            "the velocity does not have two numbers for each sample of the acceleration");
    require(recording.forceNewtons.empty() || recording.forceNewtons.size() == count,
            "the force does not have one number for each sample of the acceleration");
    require(std::isfinite(recording.constantVelocityMps[0]) && std::isfinite(recording.constantVelocityMps[1]),
            "the constant velocity is not finite");
    require(std::isfinite(recording.constantForceNewtons) && recording.constantForceNewtons >= 0.0,
            "the constant force is " + plainNumber(recording.constantForceNewtons) + " N; expected 0 or more");
}

void checkRecording(const Recording& recording) {
    checkSizes(recording);
    if (recording.seconds() < minimumSlidingSeconds) {
        throw RecordingUnusable("the recording lasts " + plainNumber(recording.seconds()) +
                                " s; record 10 s or more of sliding");
    }
    double rms = 0.0;
    for (std::size_t axis = 0; axis < recording.axisCount; ++axis) {
        const AxisFigures figures = figuresOf(recording, axis);
        const std::string name = recording.axisCount == 1 ? "the acceleration" : "axis " + std::to_string(axis + 1);
        const auto count = static_cast<double>(figures.recorded);
        if (static_cast<double>(figures.finite) < (1.0 - maximumLostShare) * count) {
            throw RecordingUnusable(name + " is not finite in " +
                                    plainNumber(100.0 - 100.0 * static_cast<double>(figures.finite) / count) +
                                    " % of its samples; record again, or cut the damaged part off");
        }
        const double clipped = clippedShare(recording.accelerationMps2.subspan(axis), recording.axisCount);
        if (clipped > maximumClippedShare) {
            throw RecordingUnusable(name + " is clipped: " + plainNumber(100.0 * clipped) +
                                    " % of its samples stand at its largest or smallest value; record again with a "
                                    "larger range");
        }
        rms = std::max(rms, figures.rms);
    }
    if (!(rms > 0.0)) {
        throw RecordingUnusable("the acceleration never changes; is the sensor connected?");
    }
}

}  // namespace haptoflow::recordings
