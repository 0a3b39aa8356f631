#include "engine/seam_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haptoflow::engine {

SeamStatistics measureSeams(std::span<const float> waveform, std::span<const std::int64_t> seams,
                            std::size_t spliceSamples) {
    SeamStatistics statistics;
    if (waveform.size() < 2) {
        return statistics;
    }
    std::vector<float> differences(waveform.size(), 0.0F);
    for (std::size_t i = 1; i < waveform.size(); ++i) {
        differences[i] = std::abs(waveform[i] - waveform[i - 1]);
    }
    std::vector<float> ranked(differences.begin() + 1, differences.end());
    const auto rank = static_cast<std::size_t>(0.999 * static_cast<double>(ranked.size() - 1));
    std::ranges::nth_element(ranked, ranked.begin() + static_cast<std::ptrdiff_t>(rank));
    const float percentile = ranked[rank];

    std::vector<bool> inSeam(waveform.size(), false);
    std::size_t outliers = 0;
    for (const std::int64_t seam : seams) {
        if (seam < 1 || seam >= static_cast<std::int64_t>(waveform.size())) {
            continue;
        }
        ++statistics.seams;
        const auto first = static_cast<std::size_t>(seam);
        const std::size_t end = std::min(first + std::max<std::size_t>(spliceSamples, 1), waveform.size());
        float largest = 0.0F;
        for (std::size_t i = first; i < end; ++i) {
            inSeam[i] = true;
            largest = std::max(largest, differences[i]);
        }
        outliers += largest > percentile ? 1U : 0U;
    }
    double seamSquares = 0.0;
    double otherSquares = 0.0;
    std::size_t seamSteps = 0;
    for (std::size_t i = 1; i < differences.size(); ++i) {
        const double square = static_cast<double>(differences[i]) * static_cast<double>(differences[i]);
        (inSeam[i] ? seamSquares : otherSquares) += square;
        seamSteps += inSeam[i] ? 1U : 0U;
    }
    const std::size_t otherSteps = differences.size() - 1 - seamSteps;
    if (statistics.seams > 0) {
        statistics.outlierShare = static_cast<double>(outliers) / static_cast<double>(statistics.seams);
    }
    if (seamSteps > 0 && otherSteps > 0 && otherSquares > 0.0) {
        statistics.jumpRatio = std::sqrt((seamSquares / static_cast<double>(seamSteps)) /
                                         (otherSquares / static_cast<double>(otherSteps)));
    }
    return statistics;
}

}  // namespace haptoflow::engine
