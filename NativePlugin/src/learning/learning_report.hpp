#pragma once

#include "learning/closed_loop.hpp"
#include "learning/learning_settings.hpp"
#include "learning/level_law.hpp"
#include "learning/texture_figures.hpp"
#include "learning/tone_fit.hpp"
#include "learning/wave_vectors.hpp"
#include "model/model_file.hpp"
#include "recordings/sensor_noise.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::learning {

struct TierDistance {
    std::string tier;
    double spectralDistanceDb = 0.0;
    /// True if it is larger than that of the fitted tier by more than 0.3 dB, so that a user should know.
    bool isFurtherOff = false;
};

/// What was recorded and what was learnt in one range of speed.
struct SpeedComparison {
    /// Geometric mean of the range.
    double speedMps = 0.0;
    /// Duration of its sliding.
    double seconds = 0.0;
    /// One curve of power density and its RMS, in dB relative to 1 (m/s^2)^2 / Hz and in m/s^2.
    struct Curve {
        std::vector<double> decibels;
        double rmsMps2 = 0.0;
        WaveFigures figures;
    };
    Curve recorded;
    Curve learnt;
    Curve nearestLabel;
};

/// What was recorded and what was learnt in one range of force.
struct ForceComparison {
    /// Mean of the range.
    double forceNewtons = 0.0;
    /// 2nd and 98th percentile of the speeds that were recorded with it: beyond them the material is extrapolated.
    std::array<double, 2> recordedMps{};
    /// Levels in m/s^2 at `LearningReport::lawSpeedsMps`.
    std::vector<double> learntMps2;
    std::vector<double> nearestLabelMps2;
    struct AtSpeed {
        double speedMps = 0.0;
        WaveFigures recorded;
        WaveFigures learnt;
        WaveFigures nearestLabel;
    };
    /// Ranges of speed with recorded frames.
    std::vector<AtSpeed> speeds;
};

/// Results of learning.
struct LearningReport {
    /// The label whose render along the recording's own motion is nearest to it. The search begins there, and what a
    /// recording of sliding does not show is copied from it.
    std::string startLabel;
    /// The label whose embedding is nearest to the learnt one; see ModelFile::nearestLabel.
    std::string nearestLabel;
    /// Distance between the closed loop and the recording, before the tone, in dB; see textureDistance.
    double startDistanceDb = 0.0;
    double fittedDistanceDb = 0.0;
    /// Distance after the tone: root mean square difference of the mean spectra, 20-450 Hz, over the speeds.
    double spectralDistanceDb = 0.0;
    /// The same for each other tier of the model with this material, for which the tone was not fitted.
    std::vector<TierDistance> otherTiers;
    /// Maximum size of the level's error over the speeds.
    double levelErrorDb = 0.0;
    /// The frequencies of the curves, and the curves of each range of speed.
    std::vector<double> comparedHz;
    std::vector<SpeedComparison> comparisons;
    /// From 5 mm/s to 1 m/s, wherever the recording was made; and the levels there for each range of force.
    std::vector<double> lawSpeedsMps;
    std::vector<ForceComparison> forces;
    /// Duration of the sliding that was used.
    double slidingSeconds = 0.0;
    /// What was removed from the recording before anything was learnt.
    recordings::NoiseSource noiseSource = recordings::NoiseSource::none;
    double noiseMps2 = 0.0;
    std::array<double, 2> speedMps{};
    std::array<double, 2> forceNewtons{};
    double speedExponent = 0.0;
    double forceExponent = 0.0;
    /// In the material's frame; the first is parallel to its first axis.
    std::vector<WaveVector> waveVectors;
    /// Angle from the recording's first axis to the material's; 0 without ribs.
    double turnDegrees = 0.0;
    std::size_t toneSpeeds = 0;
    std::uint64_t segments = 0;
    std::uint64_t generations = 0;
    /// Processor time of the calling thread.
    double seconds = 0.0;
    bool stoppedEarly = false;
    /// What to record next to gain most; empty if nothing much is missing.
    std::string recordNext;
    std::vector<std::string> warnings;
};

/// The report as JSON, ending in a line feed.
[[nodiscard]] std::string reportJson(const LearningReport& report);

/// The content of a material file.
struct MaterialContent {
    const LearningSettings& settings;
    const LearningReport& report;
    /// The label at which the search began: source of the properties that the recording does not show.
    const model::Label& start;
    const Embedding& embedding;
    const LevelLaw& level;
    const model::ToneTable& tone;
    float impulseGain = 1.0F;
    double frequencyExponent = 0.0;
    std::optional<double> wavelengthMetres;
};

/// The text of a `.haptomaterial` file, ending in a line feed.
[[nodiscard]] std::string materialText(const model::ModelFile& model, const MaterialContent& content);

}  // namespace haptoflow::learning
