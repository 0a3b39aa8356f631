#pragma once

#include "inference/load_limits.hpp"
#include "inference/segment_generator.hpp"
#include "learning/closed_loop.hpp"
#include "learning/level_law.hpp"
#include "learning/texture_figures.hpp"
#include "learning/tone_fit.hpp"
#include "learning/wave_vectors.hpp"
#include "model/model_file.hpp"
#include "recordings/sensor_noise.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::learning {

/// Maximum number of segments that the fit generates: about eight seconds on one core.
inline constexpr std::uint64_t defaultSegmentBudget = 42'000;
inline constexpr double defaultSecondsLimit = 20.0;

struct LearningSettings {
    /// Lower case like a label's, 1 to 128 bytes.
    std::string name;
    /// Empty for that of the start label; see LearningReport.
    std::string category;
    std::string description;
    /// Empty for "unknown".
    std::string licence;
    /// Description of the recordings, for the provenance.
    std::string recordings;
    std::uint64_t seed = 1;
    /// Limit of the calling thread's processor time in seconds. The fit ends there with its best result, which then
    /// depends on the machine's speed.
    double secondsLimit = defaultSecondsLimit;
    std::uint64_t segmentBudget = defaultSegmentBudget;
    /// Empty to search the embedding. A label of the model: its embedding and wave vectors are kept, in the recording's
    /// own frame, and only level and tone are fitted.
    std::string keptLabel{};
    /// k1x, k1y, k2x, k2y in cycles per millimetre along the recording's axes, zero for none; empty to estimate them.
    std::optional<std::array<double, 2 * inference::ribCount>> waveVectors{};
    /// Receives the completed share, 0 to 1, and the name of the present step.
    std::function<void(double, const char*)> progress{};
    /// Null for none.
    const inference::Cancellation* cancellation = nullptr;
};

/// Throws std::invalid_argument for a name or another text that a material file may not contain, and for wave vectors
/// outside the possible range.
void checkSettings(const LearningSettings& settings);

/// Processor time of the calling thread in seconds; elapsed time on platforms that do not count it. Only differences on
/// one thread are meaningful.
[[nodiscard]] double threadSeconds() noexcept;

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
