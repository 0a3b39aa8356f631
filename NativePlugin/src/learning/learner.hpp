#pragma once

#include "inference/cancellation.hpp"
#include "inference/segment_generator.hpp"
#include "learning/recording.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::learning {

/// Segments that the fit may ask the network for: about eight seconds of one core.
inline constexpr std::uint64_t usualSegmentBudget = 42'000;
inline constexpr double usualSecondsLimit = 20.0;

struct LearningSettings {
    /// Lower case, as a label's, 1 to 128 bytes.
    std::string name;
    /// Empty for the nearest label's.
    std::string category;
    std::string description;
    /// Empty for "unknown".
    std::string licence;
    /// What was recorded, for the provenance.
    std::string recordings;
    /// YYYY-MM-DD, or empty.
    std::string created;
    std::uint64_t seed = 1;
    /// Seconds of the calling thread's work. The fit stops there with what it has, and the result is then no longer the
    /// same on every machine.
    double secondsLimit = usualSecondsLimit;
    std::uint64_t segmentBudget = usualSegmentBudget;
    /// k1x, k1y, k2x, k2y in cycles per millimetre along the recording's axes, zero for none; estimated where empty.
    std::optional<std::array<double, 2 * inference::ribCount>> waveVectors{};
    /// Told the share that is done, 0 to 1, and what is being done.
    std::function<void(double, const char*)> progress{};
    /// Null for one that nobody cancels.
    const inference::Cancellation* cancellation = nullptr;
};

struct LearntWaveVector {
    double x = 0.0;
    double y = 0.0;
};

/// What was learnt, in figures.
struct LearningReport {
    std::string nearestLabel;
    /// Of the closed loop from the recording, before the tone, in dB; see textureDistance.
    double nearestDistanceDb = 0.0;
    double fittedDistanceDb = 0.0;
    /// Behind the tone: root of the mean square difference of the mean spectra, 20-450 Hz, over the speeds.
    double spectralDistanceDb = 0.0;
    /// Largest error of the level over the speeds, against the recording.
    double levelErrorDb = 0.0;
    /// Of sliding that was learnt from.
    double slidingSeconds = 0.0;
    std::array<double, 2> speedMps{};
    std::array<double, 2> forceNewtons{};
    double speedExponent = 0.0;
    double forceExponent = 0.0;
    /// In the material's frame: the first lies along its first axis.
    std::vector<LearntWaveVector> waveVectors;
    /// From the recording's first axis to the material's; 0 without ribs.
    double turnDegrees = 0.0;
    std::size_t seeds = 0;
    std::size_t toneSpeeds = 0;
    std::uint64_t segments = 0;
    std::uint64_t generations = 0;
    /// Of the calling thread's work.
    double seconds = 0.0;
    bool stoppedEarly = false;
    std::vector<std::string> warnings;
};

struct LearntMaterial {
    /// A material file's text.
    std::string materialJson;
    LearningReport report;
};

/// Throws std::invalid_argument for a name or another text that a material file would refuse, and for wave vectors that
/// no ribs have.
void checkSettings(const LearningSettings& settings);

/// Makes a material of a recording: level law, wave vectors, embedding, tone and seeds. `generator` is the model's, of
/// any tier. Equal arguments give equal bytes. Throws RecordingUnusable, std::invalid_argument,
/// inference::LoadCancelled and inference::InferenceError. Worker thread.
[[nodiscard]] LearntMaterial learnMaterial(const Recording& recording, const model::ModelFile& model,
                                           inference::SegmentGenerator& generator, const LearningSettings& settings);

/// The report as JSON, ending in a line feed.
[[nodiscard]] std::string reportJson(const LearningReport& report);

}  // namespace haptoflow::learning
