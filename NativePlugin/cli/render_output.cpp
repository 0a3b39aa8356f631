#include "render_output.hpp"

#include "bench/measurements.hpp"
#include "effects/carrier_rendering.hpp"
#include "effects/device_loudness.hpp"
#include "effects/wave_features.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <utility>

namespace haptoflow::cli {

std::optional<clips::ClipFormat> clipFormatOf(std::string_view path) {
    for (const clips::ClipFormat format :
         {clips::ClipFormat::haptic, clips::ClipFormat::ahap, clips::ClipFormat::hjif}) {
        if (path.ends_with('.' + std::string(clips::endingOf(format)))) {
            return format;
        }
    }
    return std::nullopt;
}

std::string renderedBy(const std::string& modelName, const std::string& quality, std::uint64_t seed,
                       const std::string& licence) {
    return modelName + ", quality " + quality + ", seed " + std::to_string(seed) + "; " + licence;
}

clips::WrittenClip writeClipFile(const OutputFile& file, const clips::HapticClip& clip) {
    clips::WrittenClip written =
        clips::writeClip(clip, {.format = clipFormatOf(file.path().string()).value(), .date = bench::today()});
    writeText(file, written.text);
    return written;
}

ClipFigures writeAndCompareClip(const OutputFile& file, const clips::HapticClip& clip,
                                std::span<const float> waveMps2) {
    clips::WrittenClip written = writeClipFile(file, clip);
    const std::vector<float> played =
        clips::waveOf(clips::readClip(written.text).clip, effects::WaveFeatures::sampleRateHz);
    const std::size_t count = std::min(played.size(), waveMps2.size());
    return {.file = file.path().filename().string(),
            .transients = clip.transients.size(),
            .written = std::move(written),
            .intensity = effects::intensityErrors(waveMps2.first(count), std::span(played).first(count))};
}

effects::IntensityErrors motorErrors(std::span<const float> waveMps2) {
    constexpr double resonanceHz = 160.0;
    const effects::WaveFeatureOptions motor{
        .frameSeconds = 0.008, .minFrequencyHz = resonanceHz, .maxFrequencyHz = resonanceHz};
    return effects::intensityErrors(
        waveMps2, effects::renderCarrier(effects::framesOf(waveMps2, motor), effects::CarrierShape::held), motor);
}

void noteCoarseClip(const ClipFigures& figures) {
    const clips::ClipWriting usual;
    // The tolerance is a ratio upwards; downwards it is a little more in decibels.
    if (figures.written.amplitudeErrorDb > 1.1 * usual.toleranceDb) {
        note(figures.file + ": " + model::shortNumber(usual.pointsPerSecond) +
             " points a second follow this wave's amplitude within " +
             fixedDecimals(figures.written.amplitudeErrorDb, 1) + " dB");
    }
}

namespace {

/// For each effect that ran: its impacts or edges, and the samples that it processed.
nlohmann::ordered_json effectsOf(const engine::OfflineFigures& figures) {
    constexpr std::array<const char*, effects::effectKinds> names{"texture",      "impact",         "edge", "delay",
                                                                  "compensation", "exposure guard", "tone", "signal",
                                                                  "listen",       "relief",         "clip"};
    nlohmann::ordered_json effects = nlohmann::ordered_json::object();
    for (std::size_t kind = 0; kind < names.size(); ++kind) {
        if (figures.effectSamples[kind] > 0 || figures.effectEvents[kind] > 0) {
            effects[names[kind]] = {{"events", figures.effectEvents[kind]}, {"samples", figures.effectSamples[kind]}};
        }
    }
    return effects;
}

nlohmann::ordered_json summaryOf(const effects::IntensityErrors& errors) {
    return {{"felt_frames", errors.feltFrames},
            {"mean", errors.meanDb},
            {"mean_magnitude", errors.meanMagnitudeDb},
            {"p95", errors.percentile95Db}};
}

}  // namespace

std::string renderReport(const RenderIdentity& identity, const engine::OfflineFigures& figures) {
    const bool isSolved = !identity.solver.empty();
    nlohmann::ordered_json report{
        {"name", identity.name},
        {"model", identity.model},
        {"labels", identity.labels},
        {"wav", identity.wav},
        {"seconds", static_cast<double>(figures.outputSamples) / identity.outputRateHz},
        {"rms_mps2", figures.rmsMps2},
        {"peak", figures.peak},
        {"segments", figures.segments},
        {"inference_ms", {{"p50", figures.inferenceMsMedian}, {"p99", figures.inferenceMsP99}}},
        {"nonfinite", figures.nonFinite},
        {"underruns", figures.underruns},
        {"sketched", figures.sketched},
        {"tier", identity.tier},
        {"solver", isSolved ? nlohmann::ordered_json(identity.solver) : nlohmann::ordered_json()},
        {"steps", isSolved ? nlohmann::ordered_json(identity.steps) : nlohmann::ordered_json()},
        {"touches", figures.touches},
        {"silent_touches", figures.silentTouches},
        {"missed_touches", identity.missedTouches},
        {"onsets", figures.onsets},
        {"skipped", figures.skipped},
        {"failures", figures.failures},
        {"sanitised", figures.sanitised},
        {"limited_samples", figures.limited},
        {"effects", effectsOf(figures)},
        {"seams",
         {{"count", figures.seamStatistics.seams},
          {"outlier_share", figures.seamStatistics.outlierShare},
          {"jump_ratio", figures.seamStatistics.jumpRatio}}},
    };
    for (const ClipFigures& clip : identity.clips) {
        report["clips"].push_back({{"file", clip.file},
                                   {"amplitude_points", clip.written.amplitudePoints},
                                   {"frequency_points", clip.written.frequencyPoints},
                                   {"transients", clip.transients},
                                   {"amplitude_error_db", clip.written.amplitudeErrorDb},
                                   {"frequency_error_percent", clip.written.frequencyErrorPercent},
                                   {"intensity_error_db", summaryOf(clip.intensity)}});
    }
    return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

namespace {

using effects::WaveDecimation;
using effects::WaveFeatures;

const effects::WaveFeatureOptions& options() {
    static const effects::WaveFeatureOptions usual;
    return usual;
}

/// Zeros after the render's end: decimation and features finish the last frame so many samples later.
constexpr std::size_t trailingSamples = WaveFeatures::lookaheadSamples + WaveDecimation::delaySamples;

/// Time in the render, in seconds, of a sample of the features, with the delay of the decimation subtracted.
double secondsAt(std::uint64_t sample) {
    constexpr auto delay = static_cast<double>(WaveDecimation::delaySamples);
    return std::max(0.0, (static_cast<double>(sample) - delay) / WaveFeatures::sampleRateHz);
}

/// The part of the device's range that a controller plays by the loudness law.
float shareOf(float amplitudeMps2) {
    return effects::deviceShare(effects::DeviceKind::parametric, amplitudeMps2);
}

/// Errors of the played intensity.
nlohmann::ordered_json intensityErrors(std::span<const float> wave, std::span<const effects::WaveFrame> frames) {
    const std::vector<float> played = effects::renderCarrier(frames, effects::CarrierShape::linear);
    return {{"frames", summaryOf(effects::intensityErrors(wave, played, options()))},
            {"motor_160_hz", summaryOf(motorErrors(wave))}};
}

}  // namespace

ParametricFrames::ParametricFrames(double outputRateHz)
    : decimation_(static_cast<std::size_t>(outputRateHz / WaveFeatures::sampleRateHz)) {}

void ParametricFrames::take(std::span<const float> samples, float fullScaleMps2) {
    for (const float sample : samples) {
        float decimated = 0.0F;
        if (decimation_.take(sample * fullScaleMps2, decimated)) {
            wave_.push_back(decimated);
        }
    }
}

void ParametricFrames::finish() {
    wave_.resize(wave_.size() + trailingSamples);
}

std::vector<effects::WaveFrame> ParametricFrames::frames() const {
    WaveFeatures features(options());
    std::vector<effects::WaveFrame> frames(features.framesWithin(wave_.size()));
    frames.resize(features.process(wave_, frames).frames);
    return frames;
}

std::span<const float> ParametricFrames::wave() const {
    return std::span(wave_).subspan(WaveDecimation::delaySamples, wave_.size() - trailingSamples);
}

std::string ParametricFrames::toCsv() const {
    std::string table =
        "seconds,amplitude_mps2,frequency_hz,intensity,device_share,transient_seconds,transient_mps2,transient_hz\n";
    for (const effects::WaveFrame& frame : frames()) {
        const double seconds = secondsAt(frame.firstSample);
        const auto add = [&table](double value, char after) { (table += model::shortNumber(value)) += after; };
        add(seconds, ',');
        add(static_cast<double>(frame.amplitudeMps2), ',');
        add(static_cast<double>(frame.frequencyHz), ',');
        add(static_cast<double>(frame.intensity), ',');
        add(static_cast<double>(shareOf(frame.amplitudeMps2)), ',');
        if (frame.transient.amplitudeMps2 > 0.0F) {
            add(seconds + static_cast<double>(frame.transient.offsetSeconds), ',');
            add(static_cast<double>(frame.transient.amplitudeMps2), ',');
            add(static_cast<double>(frame.transient.frequencyHz), '\n');
        } else {
            table += ",,\n";
        }
    }
    return table;
}

std::string ParametricFrames::toJson() const {
    const std::vector<effects::WaveFrame> all = frames();
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    nlohmann::ordered_json transients = nlohmann::ordered_json::array();
    for (const effects::WaveFrame& frame : all) {
        const double seconds = secondsAt(frame.firstSample);
        rows.push_back(
            {seconds, frame.amplitudeMps2, frame.frequencyHz, frame.intensity, shareOf(frame.amplitudeMps2)});
        if (frame.transient.amplitudeMps2 > 0.0F) {
            transients.push_back({seconds + static_cast<double>(frame.transient.offsetSeconds),
                                  frame.transient.amplitudeMps2, frame.transient.frequencyHz,
                                  shareOf(frame.transient.amplitudeMps2)});
        }
    }
    const nlohmann::ordered_json document{
        {"format", "haptoflow parametric"},
        {"version", 1},
        {"frame_seconds", options().frameSeconds},
        {"frequency_range_hz", {options().minFrequencyHz, options().maxFrequencyHz}},
        {"frame_columns", {"seconds", "amplitude_mps2", "frequency_hz", "intensity", "device_share"}},
        {"frames", std::move(rows)},
        {"transient_columns", {"seconds", "amplitude_mps2", "frequency_hz", "device_share"}},
        {"transients", std::move(transients)},
        {"intensity_error_db", intensityErrors(wave_, all)},
    };
    return document.dump() + '\n';
}

}  // namespace haptoflow::cli
