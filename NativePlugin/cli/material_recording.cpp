#include "material_recording.hpp"

#include "command_files.hpp"
#include "exit_codes.hpp"
#include "learning/recording.hpp"
#include "recording_sidecar.hpp"
#include "recording_table.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

constexpr double unknownNumber = std::numeric_limits<double>::quiet_NaN();
/// A longer step between time stamps is a gap in the recording.
constexpr double maximumStepSeconds = 0.005;
constexpr double slopeWindowSeconds = 0.09;
constexpr double minimumSpeedMps = 0.0005;

using learning::plainNumber;

[[noreturn]] void fail(const std::string& path, const std::string& found, const std::string& expected) {
    throw InputError(path + ": " + found + "; expected " + expected);
}

/// Numbers at increasing times; `width` numbers for each time.
struct Track {
    std::vector<double> timeSeconds;
    std::vector<double> values;
    std::size_t width = 1;
};

/// The rows of a series that have a time and all of their numbers.
Track trackOf(const std::string& path, std::span<const double> time, const TableSeries& series) {
    Track track{.timeSeconds = {}, .values = {}, .width = series.width};
    for (std::size_t row = 0; row < series.count(); ++row) {
        const auto cells = std::span(series.values).subspan(row * series.width, series.width);
        if (!std::isfinite(time[row]) ||
            !std::ranges::all_of(cells, [](double value) { return std::isfinite(value); })) {
            continue;
        }
        if (!track.timeSeconds.empty() && !(time[row] > track.timeSeconds.back())) {
            fail(path,
                 "time_s does not rise at row " + std::to_string(row + 2) + " (" + std::to_string(time[row]) + ")",
                 "every time later than the one before");
        }
        track.timeSeconds.push_back(time[row]);
        track.values.insert(track.values.end(), cells.begin(), cells.end());
    }
    if (track.timeSeconds.size() < 4) {
        fail(path, std::to_string(track.timeSeconds.size()) + " rows with numbers in " + series.columns,
             "4 rows at least");
    }
    return track;
}

double medianStep(std::span<const double> time) {
    std::vector<double> steps(time.size() - 1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i] = time[i + 1] - time[i];
    }
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

/// Looks up positions along a track for increasing times.
class Cursor {
public:
    explicit Cursor(const Track& track) : track_(track) {}

    /// The index of the last reading at or before the time, limited so that another reading follows.
    std::size_t before(double seconds) {
        while (at_ + 2 < track_.timeSeconds.size() && track_.timeSeconds[at_ + 1] <= seconds) {
            ++at_;
        }
        return at_;
    }

    [[nodiscard]] double linear(std::size_t index, std::size_t column, double seconds) const {
        const double start = track_.timeSeconds[index];
        const double share = std::clamp((seconds - start) / (track_.timeSeconds[index + 1] - start), 0.0, 1.0);
        const double one = track_.values[index * track_.width + column];
        return one + share * (track_.values[(index + 1) * track_.width + column] - one);
    }

    /// A cubic through the four nearest readings, for uneven time stamps well above the signal's band.
    [[nodiscard]] double cubic(std::size_t index, std::size_t column, double seconds) const {
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

private:
    const Track& track_;
    std::size_t at_ = 0;
};

/// The readings at which the tracker measured a new value: rows that repeat an older reading would look like rests and
/// jumps.
Track readAnew(const Track& track) {
    std::vector<std::size_t> changes{0};
    const std::size_t count = track.timeSeconds.size();
    const auto row = [&](std::size_t i) { return std::span(track.values).subspan(i * track.width, track.width); };
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
    Track result{.timeSeconds = {}, .values = {}, .width = track.width};
    changes.push_back(count);
    for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
        // Readings of a tip at rest are kept, too.
        std::size_t at = changes[i];
        do {
            result.timeSeconds.push_back(track.timeSeconds[at]);
            result.values.insert(result.values.end(), row(at).begin(), row(at).end());
            at += period;
        } while (at + period <= changes[i + 1]);
    }
    return result;
}

/// Velocities from positions: the slope of a cubic fitted to a window of evenly spaced readings (Savitzky-Golay). The
/// fit averages out the tracker's resolution and has no bias at constant speed or acceleration.
Track slopesOf(const Track& positions) {
    const Track read = readAnew(positions);
    const double step = std::max(medianStep(read.timeSeconds), 1e-3);
    const double start = read.timeSeconds.front();
    const auto count = static_cast<std::size_t>((read.timeSeconds.back() - start) / step) + 1;
    Track even{.timeSeconds = {}, .values = {}, .width = 2};
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
    Track velocities{.timeSeconds = even.timeSeconds, .values = std::vector<double>(even.values.size()), .width = 2};
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

Track velocityOf(const Track& motion, MotionForm form) {
    if (form == MotionForm::position) {
        return slopesOf(motion);
    }
    if (form == MotionForm::velocity) {
        return motion;
    }
    Track velocity{.timeSeconds = motion.timeSeconds, .values = {}, .width = 2};
    for (const double speed : motion.values) {
        velocity.values.push_back(std::abs(speed));
        velocity.values.push_back(0.0);
    }
    return velocity;
}

std::string otherUnit(const std::string& columns) {
    if (columns == "speed_mps") {
        return "m/s; name the column speed_mmps where it is in mm/s";
    }
    if (columns == "speed_mmps") {
        return "mm/s; name the column speed_mps where it is in m/s";
    }
    if (columns.starts_with("position_x_mm")) {
        return "millimetres; name the columns position_x_m, position_y_m where they are in metres";
    }
    if (columns.starts_with("position_x_m")) {
        return "metres; name the columns position_x_mm, position_y_mm where they are in millimetres";
    }
    return "m/s (a thousandth of mm/s)";
}

void checkSpeeds(const std::string& path, const std::string& columns, const Track& velocity) {
    std::vector<double> speeds;
    for (std::size_t i = 0; i < velocity.timeSeconds.size(); ++i) {
        speeds.push_back(std::hypot(velocity.values[2 * i], velocity.values[2 * i + 1]));
    }
    std::ranges::sort(speeds);
    const double fast = speeds[speeds.size() * 95 / 100];
    const auto moving = std::ranges::upper_bound(speeds, 0.2 * fast);
    if (moving == speeds.end()) {
        return;
    }
    const double median = *(moving + (speeds.end() - moving) / 2);
    if (!(median > minimumSpeedMps && median < learning::maximumHandSpeedMps)) {
        const std::string first = columns.substr(0, columns.find(','));
        fail(path, first + " gives a speed of " + plainNumber(median) + " m/s", otherUnit(columns));
    }
}

/// Throws if three axes at rest show gravity in units of g.
void checkGravity(const std::string& path, const TableSeries& acceleration) {
    if (acceleration.width != 3 || !acceleration.columns.ends_with("mps2")) {
        return;
    }
    std::array<double, 3> mean{};
    std::size_t count = 0;
    for (std::size_t row = 0; row < acceleration.count(); ++row) {
        const auto cells = std::span(acceleration.values).subspan(3 * row, 3);
        if (std::ranges::all_of(cells, [](double value) { return std::isfinite(value); })) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                mean[axis] += cells[axis];
            }
            ++count;
        }
    }
    const double rest = std::hypot(mean[0], mean[1], mean[2]) / static_cast<double>(std::max<std::size_t>(count, 1));
    if (rest > 0.9 && rest < 1.1) {
        fail(path, "acceleration_x rests at " + plainNumber(rest) + ", which looks like g",
             "m/s^2 (9.8 at rest); name the columns acceleration_x_g and so on where they are in g");
    }
}

class Reader {
public:
    Reader(const std::string& path, const RecordingWords& words)
        : path_(path), words_(words), sidecar_(readRecordingSidecar(path)) {
        recording_.label = sidecar_.label;
        recording_.licence = sidecar_.licence;
        recording_.source = sidecar_.source;
    }

    MaterialRecording read() {
        const std::string ending = fs::path(path_).extension().string();
        if (ending == ".wav" || ending == ".WAV") {
            readWav();
        } else if (ending == ".csv" || ending == ".CSV") {
            readTable();
        } else {
            throw InputError(path_ + ": has the ending '" + ending +
                             "'; expected a recording that ends with .csv or .wav (a Parquet table is read by "
                             "`haptoflow-training`; here, save it as CSV)");
        }
        if (sidecar_.motion) {
            readMotionFile();
        }
        requireMotion();
        requireForce();
        return std::move(recording_);
    }

private:
    void note(const RecordingTable& table) {
        if (!table.unknown.empty()) {
            std::string names;
            for (const std::string& name : table.unknown) {
                names += (names.empty() ? "" : ", ") + name;
            }
            recording_.notes.push_back(table.path + ": columns " + names + " are not known and are ignored");
        }
    }

    void readWav() {
        claimInput("the recording", path_);
        constexpr const char* expected = "a WAV file of 1 or 3 channels, PCM or float";
        SF_INFO info{};
        const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open(path_.c_str(), SFM_READ, &info), sf_close);
        if (file == nullptr) {
            fail(path_, std::string("not read as WAV (") + sf_strerror(nullptr) + ")", expected);
        }
        if (info.samplerate < learning::lowestRateHz || info.samplerate > learning::highestRateHz) {
            fail(path_, std::to_string(info.samplerate) + " samples a second", "1000 to 192000");
        }
        if (info.channels != 1 && info.channels != 3) {
            fail(path_, std::to_string(info.channels) + " channels", "1 or 3: one axis, or X, Y and Z");
        }
        const std::optional<double> fullScale = words_.fullScaleMps2 ? words_.fullScaleMps2 : sidecar_.fullScaleMps2;
        if (!fullScale) {
            fail(sidecar_.path.string(), "no key 'full_scale_mps2' for " + fs::path(path_).filename().string(),
                 "\"full_scale_mps2\": the acceleration in m/s^2 that +-1 stands for; or --full-scale-mps2");
        }
        recording_.rateHz = info.samplerate;
        recording_.axisCount = static_cast<std::size_t>(info.channels);
        const auto longest = static_cast<sf_count_t>(learning::maximumSeconds * recording_.rateHz);
        const sf_count_t frames = std::min(info.frames, longest);
        recording_.accelerationMps2.resize(static_cast<std::size_t>(frames) * recording_.axisCount);
        if (sf_readf_float(file.get(), recording_.accelerationMps2.data(), frames) != frames) {
            fail(path_, "cannot be read to its end", "a whole file; is it cut off?");
        }
        if (info.frames > longest) {
            recording_.notes.push_back(path_ + ": only the first " + plainNumber(learning::maximumSeconds) +
                                       " s are read");
        }
        for (float& value : recording_.accelerationMps2) {
            value = static_cast<float>(value * *fullScale);
        }
    }

    void readTable() {
        if (words_.fullScaleMps2) {
            throw UsageError("--full-scale-mps2 is for WAV; the columns of " + path_ + " have units of their own");
        }
        RecordingTable table = readRecordingTable(path_, true);
        note(table);
        checkGravity(path_, *table.acceleration);
        const std::size_t rows = table.acceleration->count();
        if (table.timeSeconds.empty()) {
            if (!sidecar_.rateHz) {
                fail(path_, "no column time_s",
                     "a column time_s, or the key rate_hz in " + sidecar_.path.filename().string());
            }
            for (std::size_t row = 0; row < rows; ++row) {
                table.timeSeconds.push_back(static_cast<double>(row) / *sidecar_.rateHz);
            }
        }
        const Track acceleration = trackOf(path_, table.timeSeconds, *table.acceleration);
        recording_.rateHz = 1.0 / medianStep(acceleration.timeSeconds);
        if (!(recording_.rateHz >= 0.99 * learning::lowestRateHz &&
              recording_.rateHz <= 1.01 * learning::highestRateHz)) {
            fail(path_, plainNumber(recording_.rateHz) + " samples a second by time_s",
                 "1000 to 192000; time_s is in seconds");
        }
        recording_.rateHz = std::clamp(recording_.rateHz, learning::lowestRateHz, learning::highestRateHz);
        startSeconds_ = acceleration.timeSeconds.front();
        recording_.axisCount = acceleration.width;
        makeEven(acceleration);
        takeMotion(table);
    }

    void makeEven(const Track& acceleration) {
        if (acceleration.timeSeconds.back() - startSeconds_ > learning::maximumSeconds) {
            recording_.notes.push_back(path_ + ": only the first " + plainNumber(learning::maximumSeconds) +
                                       " s are read");
        }
        const double span = std::min(acceleration.timeSeconds.back() - startSeconds_, learning::maximumSeconds);
        const auto count = static_cast<std::size_t>(span * recording_.rateHz) + 1;
        const double maximumStep = std::max(maximumStepSeconds, 4.0 / recording_.rateHz);
        Cursor cursor(acceleration);
        recording_.accelerationMps2.reserve(count * acceleration.width);
        for (std::size_t i = 0; i < count; ++i) {
            const double seconds = startSeconds_ + static_cast<double>(i) / recording_.rateHz;
            const std::size_t index = cursor.before(seconds);
            const bool isGap = acceleration.timeSeconds[index + 1] - acceleration.timeSeconds[index] > maximumStep;
            for (std::size_t axis = 0; axis < acceleration.width; ++axis) {
                recording_.accelerationMps2.push_back(
                    static_cast<float>(isGap ? unknownNumber : cursor.cubic(index, axis, seconds)));
            }
        }
    }

    void readMotionFile() {
        RecordingTable table = readRecordingTable(sidecar_.motion->string(), false);
        note(table);
        if (table.timeSeconds.empty()) {
            fail(table.path, "no column time_s", "a column time_s: the motion has a clock of its own");
        }
        takeMotion(table);
    }

    void takeMotion(const RecordingTable& table) {
        if (table.motion) {
            if (hasMotion_) {
                fail(path_, "motion in the table and in the motion file", "motion in one of them");
            }
            hasMotion_ = true;
            const Track velocity = velocityOf(trackOf(table.path, table.timeSeconds, *table.motion), table.motionForm);
            checkSpeeds(table.path, table.motion->columns, velocity);
            recording_.velocityMps = onGrid(velocity);
        }
        if (table.force) {
            if (hasForce_) {
                fail(path_, "force in the table and in the motion file", "force in one of them");
            }
            hasForce_ = true;
            recording_.forceNewtons = onGrid(trackOf(table.path, table.timeSeconds, *table.force));
        }
    }

    /// The track at the recording's samples; NaN before and after the track and in its gaps.
    std::vector<float> onGrid(const Track& track) const {
        constexpr double maximumSilence = 0.25;
        const std::size_t count = recording_.accelerationMps2.size() / recording_.axisCount;
        std::vector<float> values;
        values.reserve(count * track.width);
        Cursor cursor(track);
        for (std::size_t i = 0; i < count; ++i) {
            const double seconds = startSeconds_ + static_cast<double>(i) / recording_.rateHz;
            const std::size_t index = cursor.before(seconds);
            const bool isKnown = seconds >= track.timeSeconds.front() - maximumSilence &&
                                 seconds <= track.timeSeconds.back() + maximumSilence &&
                                 track.timeSeconds[index + 1] - track.timeSeconds[index] <= maximumSilence;
            for (std::size_t column = 0; column < track.width; ++column) {
                values.push_back(static_cast<float>(isKnown ? cursor.linear(index, column, seconds) : unknownNumber));
            }
        }
        return values;
    }

    void requireMotion() {
        if (hasMotion_) {
            if (words_.speedMps) {
                throw UsageError("--speed-mps: " + path_ + " has a motion of its own; leave the option out");
            }
        } else if (words_.speedMps) {
            recording_.constantVelocityMps = {*words_.speedMps, 0.0};
        } else if (sidecar_.velocityMps) {
            recording_.constantVelocityMps = *sidecar_.velocityMps;
        } else {
            fail(path_, "no motion in it or beside it",
                 "columns " + motionForms() + "; or the key speed_mps, velocity_mps or motion in " +
                     sidecar_.path.filename().string() + "; or --speed-mps");
        }
    }

    void requireForce() {
        if (hasForce_) {
            if (words_.forceNewtons) {
                throw UsageError("--force-newtons: " + path_ + " has a force of its own; leave the option out");
            }
        } else if (words_.forceNewtons) {
            recording_.constantForceNewtons = *words_.forceNewtons;
        } else if (sidecar_.forceNewtons) {
            recording_.constantForceNewtons = *sidecar_.forceNewtons;
        } else {
            fail(path_, "no force in it or beside it",
                 "a column " + forceForms() + "; or the key force_newtons in " + sidecar_.path.filename().string() +
                     "; or --force-newtons");
        }
    }

    const std::string& path_;
    const RecordingWords& words_;
    RecordingSidecar sidecar_;
    MaterialRecording recording_;
    double startSeconds_ = 0.0;
    bool hasMotion_ = false;
    bool hasForce_ = false;
};

}  // namespace

learning::Recording MaterialRecording::view() const {
    return {.rateHz = rateHz,
            .axisCount = axisCount,
            .accelerationMps2 = accelerationMps2,
            .velocityMps = velocityMps,
            .constantVelocityMps = constantVelocityMps,
            .forceNewtons = forceNewtons,
            .constantForceNewtons = constantForceNewtons};
}

MaterialRecording readMaterialRecording(const std::string& path, const RecordingWords& words) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        throw InputError(path + ": does not exist; expected a recording that ends with .csv or .wav");
    }
    return Reader(path, words).read();
}

}  // namespace haptoflow::cli
