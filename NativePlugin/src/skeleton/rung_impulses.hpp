#pragma once

#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

/// Rare strikes made from the tails of the noise: samples beyond a rung, each ringing as a kernel of 64 taps. How often
/// a rung is exceeded is fixed; strength and ringing are the material's.
class RungImpulses {
public:
    static constexpr std::size_t taps = 64;
    /// Gains of the atoms of each rung, of the positive tail and then of the negative one.
    static constexpr std::size_t gainCount = 2 * rungCount * atomCount;

    RungImpulses();

    /// Writes the impulses of `noise`, relative to it. `gains` are outputs of the perceptron. No allocation.
    void strike(Segment noise, std::span<const float, gainCount> gains,
                std::span<float, segmentSamples> struck) const noexcept;

private:
    using Kernel = std::array<float, taps>;
    [[nodiscard]] Kernel kernelOf(std::span<const float, atomCount> gains) const noexcept;

    std::array<Kernel, atomCount> atoms_{};
    /// One over the deviation of what exceeds a rung.
    std::array<float, rungCount> scales_{};
};

}  // namespace haptoflow::skeleton
