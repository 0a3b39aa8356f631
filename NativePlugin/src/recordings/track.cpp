#include "recordings/track.hpp"

#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace haptoflow::recordings {
namespace {

constexpr double gapSeconds = 0.005;
constexpr double maximumRepeatedShare = 0.01;
constexpr std::size_t minimumRows = 4;

}  // namespace

Track trackOf(const RecordingTable& table, const TableSeries& series) {
    Track track{.timeSeconds = {}, .values = {}, .width = series.width, .lines = {}};
    std::size_t repeated = 0;
    std::size_t firstRepeated = 0;
    for (std::size_t row = 0; row < series.count(); ++row) {
        const auto cells = std::span(series.values).subspan(row * series.width, series.width);
        const double seconds = table.timeSeconds[row];
        if (!std::isfinite(seconds) || !std::ranges::all_of(cells, [](double value) { return std::isfinite(value); })) {
            continue;
        }
        if (!track.timeSeconds.empty() && seconds < track.timeSeconds.back()) {
            throw RecordingUnusable(table.path + ":" + std::to_string(table.lines[row]) +
                                    ": column time_s: runs back to " + plainNumber(seconds) +
                                    " s; expected every time later than the one before");
        }
        if (!track.timeSeconds.empty() && seconds == track.timeSeconds.back()) {
            firstRepeated = repeated == 0 ? table.lines[row] : firstRepeated;
            ++repeated;
            continue;
        }
        track.timeSeconds.push_back(seconds);
        track.values.insert(track.values.end(), cells.begin(), cells.end());
        track.lines.push_back(table.lines[row]);
    }
    if (static_cast<double>(repeated) > maximumRepeatedShare * static_cast<double>(series.count())) {
        throw RecordingUnusable(table.path + ":" + std::to_string(firstRepeated) +
                                ": column time_s: repeats the time before it, as " + std::to_string(repeated) + " of " +
                                std::to_string(series.count()) +
                                " rows do; expected every time later than the one before: write more digits, or leave "
                                "the column out and give the key rate_hz");
    }
    if (track.count() < minimumRows) {
        throw RecordingUnusable(table.path + ": " + std::to_string(track.count()) + " rows with numbers in " +
                                series.columns + "; expected 4 rows at least");
    }
    return track;
}

double medianStepSeconds(const Track& track) {
    std::vector<double> steps(track.count() - 1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i] = track.timeSeconds[i + 1] - track.timeSeconds[i];
    }
    return upperMedian(std::move(steps));
}

double rateOf(const Track& track, double roundingSeconds) {
    constexpr double longestShare = 1.9;
    constexpr double leastUncertainty = 1e-9;
    const double longest = longestShare * medianStepSeconds(track);
    double seconds = 0.0;
    std::size_t steps = 0;
    for (std::size_t i = 1; i < track.count(); ++i) {
        const double step = track.timeSeconds[i] - track.timeSeconds[i - 1];
        if (step <= longest) {
            seconds += step;
            ++steps;
        }
    }
    const double rate = static_cast<double>(steps) / seconds;
    const double uncertainty = std::max(leastUncertainty, 2.0 * roundingSeconds / seconds) * rate;
    for (const double unit : {1000.0, 100.0, 10.0, 1.0}) {
        const double round = unit * std::round(rate / unit);
        if (round > 0.0 && std::abs(round - rate) <= uncertainty) {
            return round;
        }
    }
    return rate;
}

Track withoutRounding(Track track, double rateHz, double roundingSeconds) {
    const double start = track.timeSeconds.front();
    const double tolerance = 2.0 * roundingSeconds + 4.0 * std::numeric_limits<double>::epsilon() * std::abs(start);
    std::vector<double> even(track.count());
    double previous = -1.0;
    for (std::size_t i = 0; i < even.size(); ++i) {
        const double samples = std::round((track.timeSeconds[i] - start) * rateHz);
        even[i] = start + samples / rateHz;
        if (samples <= previous || std::abs(even[i] - track.timeSeconds[i]) > tolerance) {
            return track;
        }
        previous = samples;
    }
    track.timeSeconds = std::move(even);
    return track;
}

double longestStepSeconds(double rateHz) {
    return std::max(gapSeconds, 4.0 / rateHz);
}

std::size_t Cursor::before(double seconds) {
    while (at_ + 2 < track_.timeSeconds.size() && track_.timeSeconds[at_ + 1] <= seconds) {
        ++at_;
    }
    return at_;
}

double Cursor::linear(std::size_t index, std::size_t column, double seconds) const {
    const double start = track_.timeSeconds[index];
    const double share = std::clamp((seconds - start) / (track_.timeSeconds[index + 1] - start), 0.0, 1.0);
    const double one = track_.values[index * track_.width + column];
    return one + share * (track_.values[(index + 1) * track_.width + column] - one);
}

double Cursor::cubic(std::size_t index, std::size_t column, double seconds) const {
    if (index == 0 || index + 2 >= track_.timeSeconds.size()) {
        return linear(index, column, seconds);
    }
    double sum = 0.0;
    for (std::size_t i = index - 1; i <= index + 2; ++i) {
        double factor = track_.values[i * track_.width + column];
        for (std::size_t j = index - 1; j <= index + 2; ++j) {
            if (j != i) {
                factor *= (seconds - track_.timeSeconds[j]) / (track_.timeSeconds[i] - track_.timeSeconds[j]);
            }
        }
        sum += factor;
    }
    return sum;
}

namespace {

constexpr double slopeWindowSeconds = 0.09;

Track slopesOf(const Track& positions) {
    const Track read = readAnew(positions);
    const double step = std::max(medianStepSeconds(read), 1e-3);
    const double start = read.timeSeconds.front();
    const auto count = static_cast<std::size_t>((read.timeSeconds.back() - start) / step) + 1;
    Track even{.timeSeconds = {}, .values = {}, .width = 2, .lines = {}};
    Cursor cursor(read);
    for (std::size_t i = 0; i < count; ++i) {
        const double seconds = start + static_cast<double>(i) * step;
        const std::size_t index = cursor.before(seconds);
        even.timeSeconds.push_back(seconds);
        even.values.push_back(cursor.linear(index, 0, seconds));
        even.values.push_back(cursor.linear(index, 1, seconds));
    }
    const auto half = std::max<std::ptrdiff_t>(2, std::lround(0.5 * slopeWindowSeconds / step));
    double second = 0.0;
    double fourth = 0.0;
    double sixth = 0.0;
    for (std::ptrdiff_t i = -half; i <= half; ++i) {
        const auto square = static_cast<double>(i * i);
        second += square;
        fourth += square * square;
        sixth += square * square * square;
    }
    Track velocities{
        .timeSeconds = even.timeSeconds, .values = std::vector<double>(even.values.size()), .width = 2, .lines = {}};
    for (std::size_t column = 0; column < 2; ++column) {
        for (std::ptrdiff_t n = 0; n < std::ssize(even.timeSeconds); ++n) {
            double first = 0.0;
            double third = 0.0;
            for (std::ptrdiff_t i = -half; i <= half; ++i) {
                const std::ptrdiff_t at = std::clamp<std::ptrdiff_t>(n + i, 0, std::ssize(even.timeSeconds) - 1);
                const double position = even.values[static_cast<std::size_t>(2 * at) + column];
                const auto offset = static_cast<double>(i);
                first += offset * position;
                third += offset * offset * offset * position;
            }
            velocities.values[static_cast<std::size_t>(2 * n) + column] =
                (sixth * first - fourth * third) / (second * sixth - fourth * fourth) / step;
        }
    }
    return velocities;
}

}  // namespace

Track readAnew(const Track& track) {
    std::vector<std::size_t> changes{0};
    const std::size_t count = track.count();
    const auto row = [&](std::size_t i) { return track.at(i); };
    for (std::size_t i = 1; i < count; ++i) {
        if (!std::ranges::equal(row(i), row(i - 1))) {
            changes.push_back(i);
        }
    }
    std::size_t period = 1;
    if (changes.size() > 8) {
        std::vector<double> distances;
        for (std::size_t i = 1; i < changes.size(); ++i) {
            distances.push_back(static_cast<double>(changes[i] - changes[i - 1]));
        }
        period = static_cast<std::size_t>(upperMedian(std::move(distances)));
    }
    if (period < 2) {
        return track;
    }
    Track result{.timeSeconds = {}, .values = {}, .width = track.width, .lines = {}};
    changes.push_back(count);
    for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
        // Readings of a tip at rest are kept, too.
        std::size_t at = changes[i];
        do {
            result.timeSeconds.push_back(track.timeSeconds[at]);
            result.values.insert(result.values.end(), row(at).begin(), row(at).end());
            if (!track.lines.empty()) {
                result.lines.push_back(track.lines[at]);
            }
            at += period;
        } while (at + period <= changes[i + 1]);
    }
    return result;
}

Track velocityOf(const Track& motion, MotionForm form) {
    if (form == MotionForm::position) {
        return slopesOf(motion);
    }
    if (form == MotionForm::velocity) {
        return motion;
    }
    Track velocity{.timeSeconds = motion.timeSeconds, .values = {}, .width = 2, .lines = motion.lines};
    for (const double speed : motion.values) {
        velocity.values.push_back(std::abs(speed));
        velocity.values.push_back(0.0);
    }
    return velocity;
}

}  // namespace haptoflow::recordings
