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

    /// Impulses of a piece and what rings on after it.
    using Ringing = std::array<float, pieceSamples + taps>;

    /// Adds the impulses of at most 32 samples of noise, relative to it, to `ringing`, which begins with the first of
    /// them. `gains` are outputs of the perceptron. No allocation.
    void add(std::span<const float> noise, std::span<const float, gainCount> gains, Ringing& ringing) const noexcept;

private:
    using Kernel = std::array<float, taps>;
    void addKernel(std::span<const float, atomCount> gains, float event, Kernel& kernel) const noexcept;

    std::array<Kernel, atomCount> atoms_{};
    /// One over the deviation of what exceeds a threshold.
    std::array<float, thresholdCount> scales_{};
};

/// Whether waves of this rate are heard: others are too slow or too fast to be waves, and nothing of them is computed.
[[nodiscard]] bool isHeardHz(double rateHz) noexcept;

/// Turns of a family of waves at a piece's first sample, and its rate, which is negative where the tip moves against
/// the family's direction.
struct FamilyPhase {
    double cycles = 0.0;
    double rateHz = 0.0;
};

/// A family's outputs of the perceptron: of each harmonic the cosine's and the sine's share of the swing, and of the
/// lines.
struct FamilyGains {
    std::array<float, swingHarmonics> swingCosine{};
    std::array<float, swingHarmonics> swingSine{};
    std::array<float, lineHarmonics> lineCosine{};
    std::array<float, lineHarmonics> lineSine{};
};

/// Mean square that a line adds to the drive, relative to its noise; 0 for a harmonic (from 1) that is too fast.
[[nodiscard]] double linePower(const FamilyGains& gains, double rateHz, std::size_t harmonic) noexcept;

/// What the refining graph sees, one channel after the other: a segment in unit scale, the impulses that drove it, and
/// the cosines and then the sines of the first five harmonics, summed over the families.
struct NetworkInput {
    static constexpr std::size_t channels = 2 + 2 * swingHarmonics;

    std::array<float, channels * segmentSamples> values{};
    /// The noise that drove it, which the graph does not see; a tier that starts from noise starts from this.
    std::array<float, segmentSamples> noise{};

    /// The part of a channel that belongs to a piece; the piece lies within the segment.
    [[nodiscard]] std::span<float> piece(std::size_t channel, std::size_t first, std::size_t samples) noexcept {
        return std::span(values).subspan(channel * segmentSamples + first, samples);
    }
    [[nodiscard]] Segment segment() const noexcept { return std::span(values).first<segmentSamples>(); }
};

/// What a piece shows the refining graph, and where in its segment it begins; nothing if `input` is null.
struct NetworkView {
    NetworkInput* input = nullptr;
    std::size_t first = 0;
};

/// Waves whose phase the place on the surface fixes: lines, and the swing of the noise's gain. At most 32 samples, at
/// (n + 0.5) / 2000 s.
class SurfaceWaves {
public:
    explicit SurfaceWaves(std::size_t samples) noexcept : samples_(samples) {}

    /// Adds a family that is heard, to the channels of `view`, too, if it has any. No allocation.
    void add(const FamilyPhase& phase, const FamilyGains& gains, NetworkView view = {}) noexcept;

    /// What is added to the drive, relative to its noise.
    [[nodiscard]] std::span<const float> lines() const noexcept { return std::span(lines_).first(samples_); }
    /// What is added to the natural logarithm of the noise's gain, before its limit.
    [[nodiscard]] std::span<const float> swing() const noexcept { return std::span(swing_).first(samples_); }
    /// True if a family was added.
    [[nodiscard]] bool isHeard() const noexcept { return isHeard_; }

private:
    std::size_t samples_;
    bool isHeard_ = false;
    Piece lines_{};
    Piece swing_{};
};

}  // namespace haptoflow::skeleton
