#include "clip_output.hpp"

#include "bench/measurements.hpp"
#include "effects/wave_features.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
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

}  // namespace haptoflow::cli
