#pragma once

#include "inference/load_limits.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

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

}  // namespace haptoflow::learning
