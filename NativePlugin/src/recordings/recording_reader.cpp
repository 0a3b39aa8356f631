#include "recordings/recording_reader.hpp"

#include "model/header_node.hpp"
#include "model/plain_text.hpp"
#include "recordings/force_zero.hpp"
#include "recordings/plausibility.hpp"
#include "recordings/table_rows.hpp"
#include "recordings/wave_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace haptoflow::recordings {
namespace {

namespace fs = std::filesystem;

constexpr double unknownNumber = std::numeric_limits<double>::quiet_NaN();
/// A longer step between readings of motion or force is a gap.
constexpr double longestMotionStepSeconds = 0.25;

void noteUnknown(const std::string& path, const std::vector<std::string>& unknown, std::vector<std::string>& notes) {
    if (!unknown.empty()) {
        notes.push_back(path + ": columns " + joined(unknown) + " are not known and are ignored");
    }
}

bool isTable(const fs::path& path) {
    return endingOf(path) == ".csv";
}

void requireKnownEnding(const fs::path& path) {
    if (!isTable(path) && endingOf(path) != ".wav" && endingOf(path) != ".w64") {
        throw RecordingUnusable(utf8Of(path) + ": has the ending '" + utf8Of(path.extension()) +
                                "'; expected a recording that ends with .csv, .wav or .w64 (a Parquet table is read by "
                                "`haptoflow-training`; here, save it as CSV)");
    }
}

std::string bytesOf(RecordingFiles& files, const std::string& role, const fs::path& path) {
    std::optional<std::string> bytes = files.read(role, path);
    if (!bytes) {
        throw RecordingUnusable(utf8Of(path) +
                                ": does not exist; expected a recording that ends with .csv, .wav or .w64");
    }
    return std::move(*bytes);
}

RecordingDescription descriptionOf(const RecordingSidecar& sidecar) {
    return {.label = sidecar.label,
            .licence = sidecar.licence,
            .source = sidecar.source,
            .sidecar = sidecar.path,
            .motion = sidecar.motion,
            .notes = {}};
}

class Reader {
public:
    Reader(RecordingFiles& files, const fs::path& path, const RecordingWords& words)
        : files_(files), file_(path), path_(utf8Of(path)), words_(words) {
        requireKnownEnding(path);
        sidecar_ = readRecordingSidecar(files, path);
        recording_.description = descriptionOf(sidecar_);
    }

    MaterialRecording read() {
        const std::string bytes = bytesOf(files_, "the recording", file_);
        isTable(file_) ? readTable(bytes) : readWave(bytes);
        if (sidecar_.motion) {
            readMotionFile(*sidecar_.motion);
        }
        takeConstants();
        checkZeroOfForce();
        clampForce();
        if (!recording_.velocityMps.empty()) {
            noteLag(path_, recording_.view(), notes());
        }
        return std::move(recording_);
    }

private:
    std::vector<std::string>& notes() { return recording_.description.notes; }

    void readWave(const std::string& bytes) {
        const WaveFile wave = readWaveFile(path_, bytes);
        if (!wave.isSizeKnown) {
            notes().push_back(path_ +
                              ": does not say how many samples it has, as files do whose writer could not go "
                              "back to their head; it is read to its end");
        }
        const std::optional<double> fullScale = words_.fullScaleMps2 ? words_.fullScaleMps2 : sidecar_.fullScaleMps2;
        if (!fullScale) {
            fail(utf8Of(sidecar_.path), "no key 'full_scale_mps2' for " + utf8Of(file_.filename()),
                 "\"full_scale_mps2\": the acceleration in m/s^2 that +-1 stands for");
        }
        Track acceleration{.timeSeconds = {}, .values = {}, .width = wave.channels, .lines = {}};
        for (std::size_t i = 0; i < wave.samples.size() / wave.channels; ++i) {
            acceleration.timeSeconds.push_back(static_cast<double>(i) / wave.rateHz);
        }
        acceleration.values.resize(wave.samples.size());
        std::ranges::transform(wave.samples, acceleration.values.begin(),
                               [&](float sample) { return static_cast<float>(sample * *fullScale); });
        takeAcceleration(wave.channels == 1 ? "channel 1" : "channel 1, channel 2, channel 3", std::move(acceleration),
                         wave.rateHz);
    }

    void readTable(const std::string& text) {
        RecordingTable table = readRecordingTable(path_, text, true);
        noteUnknown(path_, table.unknown, notes());
        if (table.timeSeconds.empty()) {
            if (!sidecar_.rateHz) {
                fail(path_, "no column time_s",
                     "a column time_s, or the key rate_hz in " + utf8Of(sidecar_.path.filename()));
            }
            for (std::size_t row = 0; row < table.acceleration->count(); ++row) {
                table.timeSeconds.push_back(static_cast<double>(row) / *sidecar_.rateHz);
            }
        }
        Track acceleration = trackOf(table, *table.acceleration);
        noteMissing(table, acceleration);
        const double rate = table.timeRoundingSeconds > 0.0 || !sidecar_.rateHz
                                ? rateOf(acceleration, table.timeRoundingSeconds)
                                : *sidecar_.rateHz;
        if (!(rate >= 0.99 * lowestRateHz && rate <= 1.01 * highestRateHz)) {
            fail(path_, plainNumber(rate) + " samples a second by time_s", "1000 to 192000; time_s is in seconds");
        }
        acceleration = withoutRounding(std::move(acceleration), rate, table.timeRoundingSeconds);
        takeAcceleration(table.acceleration->columns, std::move(acceleration),
                         std::clamp(rate, lowestRateHz, highestRateHz));
        takeMotion(table);
    }

    void noteMissing(const RecordingTable& table, const Track& acceleration) {
        const std::size_t missing = table.acceleration->count() - acceleration.count();
        if (missing > 0) {
            notes().push_back(path_ + ": " + std::to_string(missing) + " of " +
                              std::to_string(table.acceleration->count()) + " rows have no number of their own in " +
                              table.acceleration->columns + " or time_s and are left out");
        }
    }

    void takeAcceleration(const std::string& columns, Track measured, double rateHz) {
        recording_.rateHz = rateHz;
        recording_.axisCount = measured.width;
        startSeconds_ = measured.timeSeconds.front();
        recording_.tracks.acceleration = plausibleAcceleration(path_, columns, std::move(measured), notes());
        const Track& acceleration = recording_.tracks.acceleration;
        double span = acceleration.timeSeconds.back() - startSeconds_;
        if (span > maximumSeconds) {
            notes().push_back(path_ + ": only the first " + plainNumber(maximumSeconds) + " s are learnt from" +
                              gapIn(acceleration));
            span = maximumSeconds;
        }
        // The last sample may lie a rounding error before its time.
        const auto count = static_cast<std::size_t>(span * rateHz + 1e-6) + 1;
        const double longestStep = longestStepSeconds(rateHz);
        Cursor cursor(acceleration);
        recording_.accelerationMps2.reserve(count * acceleration.width);
        for (std::size_t i = 0; i < count; ++i) {
            const double seconds = startSeconds_ + static_cast<double>(i) / rateHz;
            const std::size_t index = cursor.before(seconds);
            const double sinceReading = seconds - acceleration.timeSeconds[index];
            const bool isReading = std::abs(sinceReading) < 1e-3 / rateHz;
            const bool isGap =
                !isReading && (sinceReading < 0.0 ||
                               acceleration.timeSeconds[index + 1] - acceleration.timeSeconds[index] > longestStep);
            for (std::size_t axis = 0; axis < acceleration.width; ++axis) {
                recording_.accelerationMps2.push_back(
                    static_cast<float>(isGap ? unknownNumber : cursor.cubic(index, axis, seconds)));
            }
        }
    }

    /// What a gap of minutes, such as a pause of the recorder, takes of the recording; empty without one.
    std::string gapIn(const Track& acceleration) const {
        constexpr double notedSeconds = 60.0;
        double longest = 0.0;
        double start = 0.0;
        for (std::size_t i = 1; i < acceleration.count(); ++i) {
            const double step = acceleration.timeSeconds[i] - acceleration.timeSeconds[i - 1];
            if (step > longest) {
                longest = step;
                start = acceleration.timeSeconds[i - 1] - startSeconds_;
            }
        }
        return longest < notedSeconds ? ""
                                      : ", in which time_s has a gap of " + plainNumber(longest) + " s after " +
                                            plainNumber(start) + " s: cut it out";
    }

    void readMotionFile(const fs::path& path) {
        const std::string name = utf8Of(path);
        const RecordingTable table = readRecordingTable(name, bytesOf(files_, "the motion file", path), false);
        noteUnknown(name, table.unknown, notes());
        if (table.timeSeconds.empty()) {
            fail(name, "no column time_s", "a column time_s: the motion has a clock of its own");
        }
        requireReadings(name, table);
        takeMotion(table);
    }

    /// Readings so far apart are no motion: in milliseconds, or of a log of something else.
    static void requireReadings(const std::string& name, const RecordingTable& table) {
        for (const std::optional<TableSeries>* series : {&table.motion, &table.force}) {
            if (!*series) {
                continue;
            }
            const double step = medianStepSeconds(trackOf(table, **series));
            if (step > longestMotionStepSeconds) {
                fail(name, "column time_s rises by " + plainNumber(step) + " s from reading to reading in the median",
                     "seconds, with a reading every " + plainNumber(longestMotionStepSeconds) +
                         " s at least: divide milliseconds by 1000");
            }
        }
    }

    void takeMotion(const RecordingTable& table) {
        if (table.motion) {
            if (recording_.tracks.motion.count() > 0) {
                fail(path_, "motion in the table and in the motion file", "motion in one of them");
            }
            const Track motion = trackOf(table, *table.motion);
            const Track velocity = velocityOf(motion, table.motionForm);
            checkMotion(table.path, *table.motion, table.motionForm, motion, velocity);
            recording_.velocityMps = onGrid(velocity);
            recording_.tracks.hasPositions = table.motionForm == MotionForm::position;
            recording_.tracks.motion = recording_.tracks.hasPositions ? readAnew(motion) : velocity;
        }
        if (table.force) {
            if (recording_.tracks.force.count() > 0) {
                fail(path_, "force in the table and in the motion file", "force in one of them");
            }
            recording_.tracks.force = trackOf(table, *table.force);
            checkForce(table.path, *table.force, recording_.tracks.force);
            correctForce();
            recording_.forceNewtons = onGrid(recording_.tracks.force);
            forcePath_ = table.path;
            forceColumn_ = table.force->columns;
        }
    }

    void correctForce() {
        const double sign = words_.forceSign.value_or(sidecar_.forceSign.value_or(1.0));
        const double rest = words_.forceRestNewtons.value_or(sidecar_.forceRestNewtons.value_or(0.0));
        for (double& force : recording_.tracks.force.values) {
            force = sign * (force - rest);
        }
    }

    void checkZeroOfForce() {
        if (!recording_.hasMotion() || recording_.forceNewtons.empty()) {
            return;
        }
        checkForceZero(forcePath_, forceColumn_, utf8Of(sidecar_.path.filename()), recording_.view(), notes());
    }

    /// A load cell trembles around nothing in the air.
    void clampForce() {
        for (float& force : recording_.forceNewtons) {
            force = force < 0.0F ? 0.0F : force;
        }
        for (double& force : recording_.tracks.force.values) {
            force = std::max(force, 0.0);
        }
    }

    /// The track at the recording's samples; NaN before and after the track and in its gaps.
    std::vector<float> onGrid(const Track& track) const {
        const std::size_t count = recording_.accelerationMps2.size() / recording_.axisCount;
        std::vector<float> values;
        values.reserve(count * track.width);
        Cursor cursor(track);
        for (std::size_t i = 0; i < count; ++i) {
            const double seconds = startSeconds_ + static_cast<double>(i) / recording_.rateHz;
            const std::size_t index = cursor.before(seconds);
            const bool isKnown = seconds >= track.timeSeconds.front() - longestMotionStepSeconds &&
                                 seconds <= track.timeSeconds.back() + longestMotionStepSeconds &&
                                 track.timeSeconds[index + 1] - track.timeSeconds[index] <= longestMotionStepSeconds;
            for (std::size_t column = 0; column < track.width; ++column) {
                values.push_back(static_cast<float>(isKnown ? cursor.linear(index, column, seconds) : unknownNumber));
            }
        }
        return values;
    }

    void takeConstants() {
        if (recording_.velocityMps.empty()) {
            recording_.constantVelocityMps =
                words_.speedMps ? std::optional(std::array{*words_.speedMps, 0.0}) : sidecar_.velocityMps;
        }
        if (recording_.forceNewtons.empty()) {
            recording_.constantForceNewtons = words_.forceNewtons ? words_.forceNewtons : sidecar_.forceNewtons;
        }
    }

    RecordingFiles& files_;
    const fs::path file_;
    const std::string path_;
    const RecordingWords& words_;
    RecordingSidecar sidecar_;
    MaterialRecording recording_;
    double startSeconds_ = 0.0;
    /// Of the measured force, for messages.
    std::string forcePath_;
    std::string forceColumn_;
};

}  // namespace

Recording MaterialRecording::view() const {
    return {.rateHz = rateHz,
            .axisCount = axisCount,
            .accelerationMps2 = accelerationMps2,
            .velocityMps = velocityMps,
            .constantVelocityMps = constantVelocityMps.value_or(std::array{0.0, 0.0}),
            .forceNewtons = forceNewtons,
            .constantForceNewtons = constantForceNewtons.value_or(0.0)};
}

MaterialRecording readMaterialRecording(RecordingFiles& files, const fs::path& path, const RecordingWords& words) {
    return Reader(files, path, words).read();
}

void requireMotionAndForce(const RecordingDescription& description, const fs::path& path, bool hasMotion, bool hasForce,
                           const std::string& speedOption, const std::string& forceOption) {
    const auto alternative = [](const std::string& option) { return option.empty() ? option : "; or " + option; };
    const std::string sidecar = utf8Of(description.sidecar.filename());
    if (!hasMotion) {
        fail(utf8Of(path), "no motion in it or beside it",
             "columns " + motionForms() + "; or the key speed_mps, velocity_mps or motion in " + sidecar +
                 alternative(speedOption));
    }
    if (!hasForce) {
        fail(utf8Of(path), "no force in it or beside it",
             "a column " + forceForms() + "; or the key force_newtons in " + sidecar + alternative(forceOption));
    }
}

RecordingDescription describeRecording(RecordingFiles& files, const fs::path& path) {
    requireKnownEnding(path);
    RecordingDescription description = descriptionOf(readRecordingSidecar(files, path));
    const auto describeTable = [&](const std::string& role, const fs::path& table) {
        const std::string name = utf8Of(table);
        noteUnknown(name, unknownColumns(name, bytesOf(files, role, table)), description.notes);
    };
    if (isTable(path)) {
        describeTable("the recording", path);
    }
    if (description.motion) {
        describeTable("the motion file", *description.motion);
    }
    return description;
}

std::string materialName(const RecordingDescription& description, const std::filesystem::path& path) {
    const std::string text = description.label.empty() ? utf8Of(path.stem()) : description.label;
    const bool isUtf8 = model::isUtf8(text);
    std::string name;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        const bool isSpace = letter == '_' || letter == '-' || std::isspace(code) != 0 || std::iscntrl(code) != 0 ||
                             (code >= 0x80U && !isUtf8);
        name += isSpace ? ' ' : static_cast<char>(code < 0x80U ? std::tolower(code) : code);
    }
    name = trimmed(model::shortened(trimmed(name), model::nameBytes));
    return name.empty() ? "material" : name;
}

std::string provenanceOf(const RecordingDescription& description, const std::filesystem::path& path) {
    return model::printable(utf8Of(path.filename())) + (description.source.empty() ? "" : ", " + description.source);
}

}  // namespace haptoflow::recordings
