#include "recordings/tip_motion.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace haptoflow::recordings {
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
        std::vector<std::size_t> distances;
        for (std::size_t i = 1; i < changes.size(); ++i) {
            distances.push_back(changes[i] - changes[i - 1]);
        }
        const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
        std::nth_element(distances.begin(), middle, distances.end());
        period = *middle;
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
