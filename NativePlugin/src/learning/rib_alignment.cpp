#include "learning/rib_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::learning {

std::vector<RibWay> ribWays(const PreparedRecording& recording,
                            std::span<const float, 2 * inference::ribCount> waveVectors) {
    constexpr double millimetresPerSample = 1000.0 / inference::waveformRateHz;
    if (std::ranges::all_of(waveVectors, [](float value) { return value == 0.0F; })) {
        return {};
    }
    std::vector<RibWay> ways(recording.motion.size());
    RibWay way{};
    for (std::size_t i = 0; i < ways.size(); ++i) {
        ways[i] = way;
        for (std::size_t rib = 0; rib < way.size(); ++rib) {
            way[rib] += millimetresPerSample * (static_cast<double>(waveVectors[2 * rib]) * recording.motion[i][0] +
                                                static_cast<double>(waveVectors[2 * rib + 1]) * recording.motion[i][1]);
        }
    }
    return ways;
}

RibFundamentals ribFundamentals(std::span<const float> wave, std::span<const RibWay> ways) {
    RibFundamentals fundamentals{};
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(wave.size());
        const double hann = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * place);
        for (std::size_t rib = 0; rib < fundamentals.size(); ++rib) {
            fundamentals[rib] += hann * wave[i] * std::polar(1.0, -2.0 * std::numbers::pi * ways[i][rib]);
        }
    }
    return fundamentals;
}

std::array<double, inference::ribCount> alignedPhase(const RibWay& way, const RibFundamentals& recorded,
                                                     const RibFundamentals& generated) {
    std::array<double, inference::ribCount> phase{};
    for (std::size_t rib = 0; rib < phase.size(); ++rib) {
        const double offset = (std::arg(recorded[rib]) - std::arg(generated[rib])) / (2.0 * std::numbers::pi);
        const double turns = way[rib] + offset;
        phase[rib] = turns - std::floor(turns);
    }
    return phase;
}

}  // namespace haptoflow::learning
