#pragma once

#include "skeleton/gaussian_noise.hpp"
#include "skeleton/skeleton.hpp"
#include "skeleton/surface_noise.hpp"
#include "skeleton/synthesis.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::skeleton {

/// Spatial frequency of ribs along the surface's two axes, in cycles per millimetre.
struct WaveVector {
    float x = 0.0F;
    float y = 0.0F;

    [[nodiscard]] bool isNone() const noexcept { return x == 0.0F && y == 0.0F; }
    friend bool operator==(const WaveVector&, const WaveVector&) = default;
};
using WaveVectors = std::array<WaveVector, ribCount>;

/// A family of waves at the place where a contact state was published.
struct PlacedFamily {
    FamilyPhase phase;
    /// False if the place does not tell the turns: those are then the turns with which a stream begins, and one that
    /// goes on keeps its own.
    bool isPlaced = false;
};

/// What a contact state says of the stream from then on. A plain value.
struct StreamParameters {
    SkeletonParameters skeleton;
    float levelMps2 = 0.0F;
    /// Key of the surface's noise.
    std::uint64_t surface = 0;
    /// In metres of the material. The step is that of a sample; the start counts only if `isPlaced`.
    SurfacePath path{};
    bool isPlaced = false;
    std::array<PlacedFamily, familyCount> families{};
    /// Those of the ribs: one that changes its family takes its turns along.
    WaveVectors ribs{};
};

/// The skeleton's waveform along a touch, sample by sample: a filter that continues its own past, noise of the place,
/// waves, and impulses that ring on. A new contact state changes its parameters from the next sample on, and its level
/// within 4 samples: it rises evenly in amplitude, so that a louder label is heard at once, and falls evenly in
/// decibels. A past that does not fit the new filter is left across a splice of as many. A plain
/// value: a copy goes on as the original does. Finite and bounded for every input; allocates nothing.
class Stream {
public:
    /// Begins at a contact. `samplesAhead`: samples from its publishing to the next sample. `key` is that of numbers
    /// that no place gives.
    void begin(const StreamParameters& parameters, double samplesAhead, const NoiseKey& key) noexcept;
    /// Goes on with another contact.
    void follow(const StreamParameters& parameters, double samplesAhead) noexcept;
    /// Writes the next samples in unit scale of `levelMps2`, any number; zeros without a skeleton, while place and
    /// phases go on. `input`: where to write what the refining graph sees of at most 200 samples, or null.
    void next(const Skeleton* skeleton, std::span<float> unit, NetworkInput* input = nullptr) noexcept;
    /// Level in m/s^2 of the newest contact, where the ramp ends.
    [[nodiscard]] float levelMps2() const noexcept { return levelMps2_; }
    /// Level in m/s^2 of the next sample, of the stream's and of what is added to it.
    [[nodiscard]] float nextRampedLevelMps2() noexcept;

    /// Turns at the next sample, and rates.
    [[nodiscard]] Phases phases() const noexcept;

private:
    static constexpr float lowestLevelMps2 = 1e-6F;

    struct Family {
        FamilyPhase phase;
        /// Added to each of the next samples' turns, to reach what the place says.
        double correctionCycles = 0.0;
    };

    void setParameters(const StreamParameters& parameters, double samplesAhead) noexcept;
    void rampLevelTo(float levelMps2) noexcept;
    void takePhases(const StreamParameters& parameters, double samplesAhead, bool isBeginning) noexcept;
    [[nodiscard]] std::size_t pieceOf(std::size_t wanted) const noexcept;
    [[nodiscard]] std::array<FamilyPhase, familyCount> correctedPhases() const noexcept;
    void advance(std::size_t samples) noexcept;
    [[nodiscard]] std::array<float, filterOrder> drawn() noexcept;

    SkeletonParameters skeleton_;
    Synthesis synthesis_;
    SurfaceNoise noise_;
    std::uint64_t surface_ = 0;
    SurfacePath path_{};
    NoiseKey key_{};
    std::uint64_t draws_ = 0;
    std::array<Family, familyCount> families_{};
    WaveVectors ribs_{};
    std::size_t correctedSamplesLeft_ = 0;
    float levelMps2_ = lowestLevelMps2;
    float rampedLevelMps2_ = lowestLevelMps2;
    // Each level of the ramp is the one before times the factor, plus the step.
    float levelFactor_ = 1.0F;
    float levelStepMps2_ = 0.0F;
    std::size_t levelSamplesLeft_ = 0;
};

}  // namespace haptoflow::skeleton
