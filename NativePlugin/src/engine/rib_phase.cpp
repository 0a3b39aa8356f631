#include "engine/rib_phase.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {
namespace {

constexpr double millimetresPerMetre = 1000.0;

}  // namespace

RibTurns ribTurnsPerSample(std::span<const float, inference::embeddingSize> embedding, double vxMps,
                           double vyMps) noexcept {
    const auto waveVectors = embedding.last<2 * inference::ribCount>();
    RibTurns turns;
    for (std::size_t rib = 0; rib < turns.size(); ++rib) {
        const double cyclesPerSecond = (static_cast<double>(waveVectors[2 * rib]) * vxMps +
                                        static_cast<double>(waveVectors[2 * rib + 1]) * vyMps) *
                                       millimetresPerMetre;
        turns[rib] = cyclesPerSecond / inference::waveformRateHz;
    }
    return turns;
}

void RibTrack::begin(std::int64_t start, const SeedRibs& seed) noexcept {
    pieces_[0] = {.start = start, .phase = seed.phase, .turnsPerSample = seed.turnsPerSample};
    count_ = 1;
}

std::array<float, inference::ribCount> RibTrack::at(std::int64_t sample) const noexcept {
    const RibTurns turns = turnsAt(sample);
    std::array<float, inference::ribCount> phase{};
    std::ranges::transform(turns, phase.begin(), [](double each) {
        const auto rounded = static_cast<float>(each);
        return rounded < 1.0F ? rounded : 0.0F;
    });
    return phase;
}

void RibTrack::add(std::int64_t start, const RibTurns& turnsPerSample) noexcept {
    const Piece piece{.start = start, .phase = turnsAt(start), .turnsPerSample = turnsPerSample};
    while (count_ > 0 && pieces_[count_ - 1].start >= start) {
        --count_;
    }
    if (count_ == capacity) {
        std::ranges::copy(pieces_.begin() + 1, pieces_.end(), pieces_.begin());
        --count_;
    }
    pieces_[count_] = piece;
    ++count_;
}

RibTurns RibTrack::turnsAt(std::int64_t sample) const noexcept {
    std::size_t newest = count_ - 1;
    while (newest > 0 && pieces_[newest].start > sample) {
        --newest;
    }
    const Piece& piece = pieces_[newest];
    RibTurns turns;
    for (std::size_t rib = 0; rib < turns.size(); ++rib) {
        const double travelled =
            piece.phase[rib] + piece.turnsPerSample[rib] * static_cast<double>(sample - piece.start);
        turns[rib] = travelled - std::floor(travelled);
    }
    return turns;
}

}  // namespace haptoflow::engine
