#pragma once

#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

/// Rare impulses made from the tails of the noise: samples beyond a threshold, each ringing as a kernel of 64 taps. How
/// often a threshold is exceeded is fixed; strength and ringing are the material's.
class TailImpulses {
public:
    static constexpr std::size_t taps = 64;
    /// Gains of the atoms of each threshold, of the positive tail and then of the negative one.
    static constexpr std::size_t gainCount = 2 * thresholdCount * atomCount;

    TailImpulses();

    /// Writes the impulses of `noise`, relative to it. `gains` are outputs of the perceptron. No allocation.
    void add(Segment noise, std::span<const float, gainCount> gains,
             std::span<float, segmentSamples> impulses) const noexcept;

private:
    using Kernel = std::array<float, taps>;
    [[nodiscard]] Kernel kernelOf(std::span<const float, atomCount> gains) const noexcept;

    std::array<Kernel, atomCount> atoms_{};
    /// One over the deviation of what exceeds a threshold.
    std::array<float, thresholdCount> scales_{};
};

/// Phase of a family of waves at the segment's first sample, and its rate.
struct FamilyPhase {
    double cycles = 0.0;
    /// Negative where the tip moves against the family's direction.
    double rateHz = 0.0;

    /// False where the family is too slow to be a wave: then nothing of it is computed.
    [[nodiscard]] bool isHeard() const noexcept;
};

/// A family's outputs of the perceptron: of each harmonic the cosine's and the sine's share of the swing, and of the
/// lines.
struct FamilyGains {
    std::array<float, swingHarmonics> swingCosine{};
    std::array<float, swingHarmonics> swingSine{};
    std::array<float, lineHarmonics> lineCosine{};
    std::array<float, lineHarmonics> lineSine{};
};

/// Waves whose phase the place on the surface fixes: lines, and the swing of the noise's gain. Samples are at (n + 0.5)
/// / 2000 s.
class SurfaceWaves {
public:
    /// Cosines or sines of the swing's harmonics, summed over the families.
    using Pulses = std::array<std::array<float, segmentSamples>, swingHarmonics>;

    /// Adds a family that is heard. With `cosines` and `sines`, also adds the swing's harmonics to them. No allocation.
    void add(const FamilyPhase& phase, const FamilyGains& gains, Pulses* cosines = nullptr,
             Pulses* sines = nullptr) noexcept;

    /// What is added to the drive, relative to its noise.
    [[nodiscard]] const std::array<float, segmentSamples>& lines() const noexcept { return lines_; }
    /// What is added to the natural logarithm of the noise's gain, before its limit.
    [[nodiscard]] const std::array<float, segmentSamples>& swing() const noexcept { return swing_; }
    /// True if a family was added.
    [[nodiscard]] bool isHeard() const noexcept { return isHeard_; }

private:
    bool isHeard_ = false;
    std::array<float, segmentSamples> lines_{};
    std::array<float, segmentSamples> swing_{};
};

}  // namespace haptoflow::skeleton
