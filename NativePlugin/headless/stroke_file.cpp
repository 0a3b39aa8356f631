#include "headless/stroke_file.hpp"

#include "headless/command_files.hpp"
#include "recordings/recording.hpp"
#include "recordings/table_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <utility>

namespace haptoflow::headless {
namespace {

constexpr double maximumValue = 1e9;
/// Seconds since 1970 until the year 5138; milliseconds are beyond it.
constexpr double maximumClockSeconds = 1e11;
constexpr double maximumStepSeconds = 600.0;
constexpr std::size_t maximumFrames = 10'000'000;
constexpr std::array<std::string_view, 9> columnNames{"t", "x", "y", "z", "force", "qx", "qy", "qz", "qw"};
constexpr std::string_view headerForm = "t,x,y,z[,force][,qx,qy,qz,qw]";

struct Layout {
    bool force = false;
    bool orientation = false;
    [[nodiscard]] std::size_t columns() const { return 4U + (force ? 1U : 0U) + (orientation ? 4U : 0U); }
    [[nodiscard]] std::string_view nameOf(std::size_t column) const {
        return columnNames[column >= 4 && !force ? column + 1 : column];
    }
};

struct Parts {
    double whole = 0.0;
    double fraction = 0.0;
};

/// A decimal before and after its point; a number with an exponent is its whole part.
std::optional<Parts> partsOf(std::string_view text) {
    const std::optional<double> value = recordings::decimalNumber(text);
    const std::size_t point = text.find('.');
    if (!value || point == std::string_view::npos || text.find_first_of("eE") != std::string_view::npos) {
        return value ? std::optional(Parts{.whole = *value}) : std::nullopt;
    }
    // Not the truncated value, which may have been rounded up.
    const std::optional<double> whole = recordings::decimalNumber(text.substr(0, point));
    const std::optional<double> fraction = recordings::decimalNumber(std::string("0").append(text.substr(point)));
    return Parts{.whole = whole.value_or(0.0), .fraction = std::copysign(fraction.value_or(0.0), *value)};
}

/// The difference of two decimals, such as seconds since 1970, with the digits that their own rounding to a double
/// would lose. Empty if one of them is no number.
std::optional<double> decimalDifference(std::string_view text, std::string_view origin) {
    const std::optional<Parts> number = partsOf(text);
    const std::optional<Parts> start = partsOf(origin);
    if (!number || !start) {
        return std::nullopt;
    }
    return (number->whole - start->whole) + (number->fraction - start->fraction);
}

/// Reads the text row by row and knows the position for errors.
class StrokeReader {
public:
    StrokeReader(std::string_view text, const std::string& file) : text_(text), rows_(text, columnNames), file_(file) {}

    Stroke read() {
        if (const std::string_view encoding = recordings::otherEncoding(text_); !encoding.empty()) {
            failAt(1, "is " + std::string(encoding) + "; expected UTF-8");
        }
        if (rows_.names().empty()) {
            failAt(1, "expected the header " + std::string(headerForm) + ", found an empty file");
        }
        readHeader();
        Stroke stroke;
        while (rows_.next()) {
            if (rows_.isBlank()) {
                requireNothingMore();
                break;
            }
            stroke.samples.push_back(readSample());
            const std::size_t count = stroke.samples.size();
            if (count > 1 && stroke.samples[count - 1].timeSeconds < stroke.samples[count - 2].timeSeconds) {
                fail(0, "expected a time not before the line above");
            }
            if (count > 1) {
                takeStep(stroke.samples[count - 1].timeSeconds - stroke.samples[count - 2].timeSeconds);
            }
        }
        if (stroke.samples.empty()) {
            failAt(1, "expected one or more samples after the header, found none");
        }
        requireSeconds(stroke);
        return stroke;
    }

private:
    [[noreturn]] void failAt(std::size_t line, const std::string& complaint) const {
        throw InputError(file_ + ":" + std::to_string(line) + ": " + complaint);
    }

    [[noreturn]] void fail(std::size_t column, const std::string& expected) const {
        failAt(rows_.number(), "column " + std::string(layout_.nameOf(column)) + ": " + expected + ", found \"" +
                                   std::string(rows_.cells()[column].substr(0, 40)) + "\"");
    }

    void readHeader() {
        std::vector<std::string_view> names = rows_.names();
        // Spreadsheets end lines with separators of empty columns.
        while (names.size() > 1 && names.back().empty()) {
            names.pop_back();
        }
        for (const bool force : {false, true}) {
            for (const bool orientation : {false, true}) {
                layout_ = {force, orientation};
                bool same = names.size() == layout_.columns();
                for (std::size_t column = 0; same && column < names.size(); ++column) {
                    same = names[column] == layout_.nameOf(column);
                }
                if (same) {
                    return;
                }
            }
        }
        std::string found;
        for (const std::string_view name : names) {
            found.append(found.empty() ? "" : ",").append(name);
        }
        failAt(rows_.number(),
               "expected the header " + std::string(headerForm) + ", found \"" + found.substr(0, 80) + "\"");
    }

    void requireNothingMore() {
        const std::size_t line = rows_.number();
        while (rows_.next()) {
            if (!rows_.isBlank()) {
                failAt(line, "an empty line between samples; remove it");
            }
        }
    }

    double number(std::size_t column) {
        const std::optional<double> value = rows_.decimal(column);
        if (!value || !(std::abs(*value) <= maximumValue)) {
            fail(column, "expected a number within +-1e9 with a decimal point");
        }
        return *value;
    }

    /// Times of a clock that started long ago, such as seconds since 1970, count from the first row.
    double time() {
        const std::optional<double> value = rows_.decimal(0);
        if (!value || !(std::abs(*value) <= maximumClockSeconds)) {
            fail(0, "expected seconds within +-1e11 with a decimal point");
        }
        if (isFirst_ && std::abs(*value) > maximumValue) {
            clockStart_ = rows_.withPoint(0);
        }
        isFirst_ = false;
        const double seconds =
            clockStart_ ? decimalDifference(rows_.withPoint(0), *clockStart_).value_or(*value) : *value;
        if (!(std::abs(seconds) <= maximumValue)) {
            fail(0, "expected a time within 1e9 s of the first");
        }
        return seconds;
    }

    TipSample readSample() {
        const std::vector<std::string_view>& cells = rows_.cells();
        const bool hasMore =
            std::any_of(cells.begin() + static_cast<std::ptrdiff_t>(std::min(cells.size(), layout_.columns())),
                        cells.end(), [](std::string_view cell) { return !cell.empty(); });
        if (cells.size() < layout_.columns() || hasMore) {
            failAt(rows_.number(), "expected " + std::to_string(layout_.columns()) +
                                       " values as in the header, found " + std::to_string(cells.size()) +
                                       " (decimals need a point, not a comma)");
        }
        TipSample sample;
        sample.timeSeconds = time();
        sample.positionMetres = {number(1), number(2), number(3)};
        std::size_t column = 4;
        if (layout_.force) {
            if (!recordings::isMissing(cells[column])) {
                sample.forceNewtons = number(column);
                if (*sample.forceNewtons < 0.0) {
                    fail(column,
                         "expected newtons that grow as the tip presses, 0 or more, or nothing where the stylus "
                         "measured none: turn the sign or subtract what the sensor reads in the air");
                }
            }
            ++column;
        }
        if (layout_.orientation) {
            const glm::dquat turn(number(column + 3), number(column), number(column + 1), number(column + 2));
            const double length = glm::length(turn);
            if (!(length > 1e-6)) {
                fail(column, "expected a quaternion qx,qy,qz,qw other than zero");
            }
            sample.orientation = turn / length;
        }
        return sample;
    }

    void takeStep(double seconds) {
        steps_.push_back(seconds);
        if (seconds > longestStepSeconds_) {
            longestStepSeconds_ = seconds;
            longestStepLine_ = rows_.number();
        }
    }

    /// Refuses times in another unit, and gaps of which a render would be gigabytes of silence.
    void requireSeconds(const Stroke& stroke) {
        double metres = 0.0;
        for (std::size_t i = 1; i < stroke.samples.size(); ++i) {
            metres += glm::distance(stroke.samples[i].positionMetres, stroke.samples[i - 1].positionMetres);
        }
        const std::string unit = unitOfTimes(steps_, metres);
        if (!unit.empty()) {
            throw InputError(file_ + ": column t: " + unit);
        }
        if (longestStepSeconds_ > maximumStepSeconds) {
            failAt(longestStepLine_, "column t: is " + recordings::plainNumber(longestStepSeconds_) +
                                         " s after the line above; expected steps of " +
                                         recordings::plainNumber(maximumStepSeconds) +
                                         " s at most: are there two recordings in the file, or times in another unit?");
        }
    }

    std::string_view text_;
    recordings::TableRows rows_;
    std::vector<double> steps_;
    double longestStepSeconds_ = 0.0;
    std::size_t longestStepLine_ = 0;
    const std::string& file_;
    Layout layout_;
    bool isFirst_ = true;
    /// The first row's time, of a clock whose times count from there.
    std::optional<std::string> clockStart_;
};

}  // namespace

Stroke parseStroke(std::string_view text, const std::string& fileName) {
    return StrokeReader(text, fileName).read();
}

Stroke readStrokeFile(const std::string& path) {
    return parseStroke(readInputFile("the stroke", path, "a stroke file (CSV)"), path);
}

TipSample sampleStroke(const Stroke& stroke, double timeSeconds) {
    const auto& samples = stroke.samples;
    const auto after = std::upper_bound(samples.begin(), samples.end(), timeSeconds,
                                        [](double time, const TipSample& sample) { return time < sample.timeSeconds; });
    TipSample result;
    if (after == samples.begin()) {
        result = samples.front();
    } else if (after == samples.end()) {
        result = samples.back();
    } else {
        const TipSample& a = *(after - 1);
        const TipSample& b = *after;
        const double u = (timeSeconds - a.timeSeconds) / (b.timeSeconds - a.timeSeconds);
        result.positionMetres = glm::mix(a.positionMetres, b.positionMetres, u);
        result.forceNewtons = u < 0.5 ? a.forceNewtons : b.forceNewtons;
        if (a.forceNewtons && b.forceNewtons) {
            result.forceNewtons = glm::mix(*a.forceNewtons, *b.forceNewtons, u);
        }
        if (a.orientation && b.orientation) {
            result.orientation = glm::normalize(glm::slerp(*a.orientation, *b.orientation, u));
        }
    }
    result.timeSeconds = timeSeconds;
    return result;
}

std::size_t frameCount(const Stroke& stroke, double updateRateHz, const std::string& fileName) {
    const double seconds = stroke.samples.back().timeSeconds - stroke.samples.front().timeSeconds;
    // A last frame that misses the last sample only by rounding counts.
    const double frames = std::floor(seconds * updateRateHz + 1e-6) + 1.0;
    if (frames > static_cast<double>(maximumFrames)) {
        throw InputError(fileName + ": " + std::to_string(seconds) +
                         " s at the scene's update_rate are more than ten million frames; expected a shorter stroke");
    }
    return static_cast<std::size_t>(frames);
}

TipSample frameAt(const Stroke& stroke, double updateRateHz, std::size_t index) {
    return sampleStroke(stroke, stroke.samples.front().timeSeconds + static_cast<double>(index) / updateRateHz);
}

namespace {

/// Trackers, scenes and hands have shorter steps, and waypoints fewer of them or more speed.
constexpr double longStepSeconds = 0.5;
constexpr double longestWaypointSeconds = 300.0;
constexpr std::size_t fewSteps = 3;
constexpr std::size_t manySteps = 30;
constexpr double longestTrackedSeconds = 2.0;
/// No hand is slower for long, and none is faster.
constexpr double slowestMps = 0.002;
constexpr double fastestMps = 10.0;
constexpr double longestReadableSeconds = 0.5;

}  // namespace

std::string unitOfTimes(std::span<const double> steps, double metres) {
    if (steps.empty()) {
        return {};
    }
    constexpr std::array<std::pair<const char*, double>, 3> units{
        {{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}}};
    const double step = recordings::upperMedian({steps.begin(), steps.end()});
    const double seconds = std::accumulate(steps.begin(), steps.end(), 0.0);
    const double speedMps = seconds > 0.0 ? metres / seconds : 0.0;
    for (const auto& [name, perSecond] : units) {
        const bool isPlausible =
            speedMps < slowestMps && speedMps * perSecond >= slowestMps && speedMps * perSecond <= fastestMps;
        const bool isLong = steps.size() >= fewSteps ? step >= longStepSeconds : step >= longestWaypointSeconds;
        const bool isTracked =
            steps.size() >= manySteps && step >= longestTrackedSeconds && step / perSecond <= longestReadableSeconds;
        if ((isLong && isPlausible) || isTracked) {
            return "rises by " + recordings::plainNumber(step) + " s a row in the median, with a speed of " +
                   recordings::plainNumber(1e3 * speedMps) + " mm/s; expected seconds: are these " + name +
                   "? Divide them by " + recordings::plainNumber(perSecond);
        }
    }
    return {};
}

}  // namespace haptoflow::headless
