#include "learning/level_calibration.hpp"

#include "dsp/tone_cepstrum.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

/// The stretch behind the tone of its mean speed; the filter has settled after `dsp::toneTaps` samples.
std::vector<float> toned(const LoopStretch& stretch, const recordings::PreparedRecording& recording,
                         const model::ToneTable& tone) {
    if (tone.speedsMps.empty()) {
        return stretch.wave;
    }
    double logSpeed = 0.0;
    for (std::size_t i = 0; i < stretch.wave.size(); ++i) {
        logSpeed += std::log(std::max(recording.speedMps(stretch.start + i), minimumSlidingMps)) /
                    static_cast<double>(stretch.wave.size());
    }
    const double speed = std::exp(logSpeed);
    const dsp::ToneKernel kernel =
        dsp::toneKernel(dsp::toneCepstrum([&](double hertz) { return tone.gainDb(speed, std::max(hertz, 1.0)); }));
    std::vector<float> result(stretch.wave.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t tap = 0; tap < std::min(kernel.size(), i + 1); ++tap) {
            result[i] += kernel[tap] * stretch.wave[i - tap];
        }
    }
    return result;
}

}  // namespace

LevelLaw calibratedLevel(const LevelLaw& law, const recordings::PreparedRecording& recording, const Sliding& sliding,
                         std::span<const LoopStretch> stretches, const model::ToneTable& tone,
                         const ExponentPrior& prior) {
    constexpr std::size_t hop = levelFrameSamples / 2;
    constexpr double maximumShift = 1.5;
    std::vector<LevelFrame> recorded;
    std::vector<LevelFrame> generated;
    for (const LoopStretch& stretch : stretches) {
        std::vector<float> wave = toned(stretch, recording, tone);
        for (std::size_t i = 0; i < wave.size(); ++i) {
            const std::size_t at = stretch.start + i;
            wave[i] *= static_cast<float>(std::exp(law.logLevel(recording.speedMps(at), recording.motion[at][2])));
        }
        for (std::size_t at = hop; at + levelFrameSamples <= wave.size(); at += hop) {
            const std::size_t start = stretch.start + at;
            if (sliding.holds(start, levelFrameSamples)) {
                const auto motion = std::span(recording.motion).subspan(start, levelFrameSamples);
                recorded.push_back(levelFrame(std::span(recording.wave).subspan(start, levelFrameSamples), motion));
                generated.push_back(levelFrame(std::span(wave).subspan(at, levelFrameSamples), motion));
            }
        }
    }
    if (recorded.empty()) {
        return law;
    }
    const LevelLaw wanted = fitLevelLaw(recorded, prior);
    const LevelLaw made = fitLevelLaw(generated, prior);
    LevelLaw result = law;
    for (std::size_t i = 0; i < law.table.speedsMps.size(); ++i) {
        const double speed = law.table.speedsMps[i];
        const double shift =
            wanted.logLevel(speed, law.table.forceNewtons) - made.logLevel(speed, law.table.forceNewtons);
        result.table.logLevels[i] += std::clamp(shift, -maximumShift, maximumShift);
    }
    return result;
}

}  // namespace haptoflow::learning
