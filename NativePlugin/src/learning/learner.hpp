#pragma once

#include "inference/cancellation.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"
#include "recordings/recording.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::learning {

/// Maximum number of segments that the fit generates: about eight seconds on one core.
inline constexpr std::uint64_t defaultSegmentBudget = 42'000;
inline constexpr double defaultSecondsLimit = 20.0;

struct LearningSettings {
    /// Lower case like a label's, 1 to 128 bytes.
    std::string name;
    /// Empty for that of the nearest label.
    std::string category;
    std::string description;
    /// Empty for "unknown".
    std::string licence;
    /// Description of the recordings, for the provenance.
    std::string recordings;
    /// YYYY-MM-DD, or empty.
    std::string created;
    std::uint64_t seed = 1;
    /// Limit of the calling thread's processor time in seconds. The fit ends there with its best result, which then
    /// depends on the machine's speed.
    double secondsLimit = defaultSecondsLimit;
    std::uint64_t segmentBudget = defaultSegmentBudget;
    /// k1x, k1y, k2x, k2y in cycles per millimetre along the recording's axes, zero for none; empty to estimate them.
    std::optional<std::array<double, 2 * inference::ribCount>> waveVectors{};
    /// Receives the completed share, 0 to 1, and the name of the present step.
    std::function<void(double, const char*)> progress{};
    /// Null for none.
    const inference::Cancellation* cancellation = nullptr;
};

struct LearntWaveVector {
    double x = 0.0;
    double y = 0.0;
};

/// Results of learning.
struct LearningReport {
    std::string nearestLabel;
    /// Distance between the closed loop and the recording, before the tone, in dB; see textureDistance.
    double nearestDistanceDb = 0.0;
    double fittedDistanceDb = 0.0;
    /// Distance after the tone: root mean square difference of the mean spectra, 20-450 Hz, over the speeds.
    double spectralDistanceDb = 0.0;
    /// Maximum error of the level over the speeds.
    double levelErrorDb = 0.0;
    /// Duration of the sliding that was used.
    double slidingSeconds = 0.0;
    std::array<double, 2> speedMps{};
    std::array<double, 2> forceNewtons{};
    double speedExponent = 0.0;
    double forceExponent = 0.0;
    /// In the material's frame; the first is parallel to its first axis.
    std::vector<LearntWaveVector> waveVectors;
    /// Angle from the recording's first axis to the material's; 0 without ribs.
    double turnDegrees = 0.0;
    std::size_t seeds = 0;
    std::size_t toneSpeeds = 0;
    std::uint64_t segments = 0;
    std::uint64_t generations = 0;
    /// Processor time of the calling thread.
    double seconds = 0.0;
    bool stoppedEarly = false;
    std::vector<std::string> warnings;
};

struct LearntMaterial {
    /// Text of the material file.
    std::string materialJson;
    LearningReport report;
};

/// Throws std::invalid_argument for a name or another text that a material file may not contain, and for wave vectors
/// outside the possible range.
void checkSettings(const LearningSettings& settings);

/// Learns a material from a recording: level law, wave vectors, embedding, tone and seeds. `generator` is one of the
/// model's tiers. Equal arguments give equal bytes. Throws recordings::RecordingUnusable, std::invalid_argument,
/// inference::LoadCancelled and inference::InferenceError. For worker threads.
[[nodiscard]] LearntMaterial learnMaterial(const recordings::Recording& recording, const model::ModelFile& model,
                                           inference::SegmentGenerator& generator, const LearningSettings& settings);

/// The report as JSON, ending in a line feed.
[[nodiscard]] std::string reportJson(const LearningReport& report);

}  // namespace haptoflow::learning
