#pragma once

#include "model/model_header.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/excitation.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/reflection_filter.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

/// A material's level: a power law of speed and force whose three numbers are linear in the embedding, and a correction
/// of at most +-0.9 by a perceptron, which also sees how fast the tip crosses the material's ribs.
class LevelModel {
public:
    static constexpr std::size_t correctionInputs = model::embeddingSize + smoothFeatures + ribCount;

    /// `law`: 64 inputs, 3 outputs. `correction`: 64 + 12 + 2 inputs, 1 output.
    LevelModel(LinearLayer law, Perceptron correction);

    /// The natural logarithm of the RMS in m/s^2; not finite if an argument is not. Any thread; no allocation.
    [[nodiscard]] float logLevel(std::span<const float, model::embeddingSize> embedding,
                                 const Motion& motion) const noexcept;

private:
    LinearLayer law_;
    Perceptron correction_;
};

/// What a segment is made of. The spans must live while it is used.
struct Moment {
    std::span<const float, embeddingSize> embedding;
    Motion motion{};
    Phases phases{};
    /// The 200 samples before the segment in unit scale, limited to +-16.
    Segment previous;
    /// Standard normal; limited to +-9, a sample that is not a number counts as 0.
    Segment noise;
    float impulseGain = 1.0F;
};

/// The last layer of the perceptron `skeleton`, cut by what its outputs are for, so that a family that is not heard
/// costs nothing.
struct OutputLayers {
    /// Reflections and gain.
    LinearLayer filter;
    /// Of each family the swing's cosines and sines, then the lines' cosines and sines.
    std::array<LinearLayer, familyCount> families;
    LinearLayer impulseGains;
};

/// The parameters of a segment.
struct SegmentParameters {
    ReflectionFilter filter;
    /// Zero for a family that is not heard.
    std::array<FamilyGains, familyCount> families{};
    std::array<float, TailImpulses::gainCount> impulseGains{};
};

/// What sounds without a graph: a filter continues the previous waveform, driven by noise, by the lines of ribs and
/// stick-slip, and by impulses. Immutable, so that any number of threads may use it; allocates nothing while it runs.
/// The result is finite for any argument, and the segment within +-16.
class Skeleton {
public:
    /// Channels of what the refining graph sees.
    static constexpr std::size_t networkInputChannels = 2 + 2 * swingHarmonics;

    Skeleton(HiddenLayers hidden, OutputLayers outputs);

    [[nodiscard]] SegmentParameters parametersFor(const Condition& condition,
                                                  const std::array<FamilyPhase, familyCount>& phases,
                                                  float impulseGain = 1.0F) const noexcept;
    /// The filter alone, which costs a fraction of the whole.
    [[nodiscard]] ReflectionFilter filterFor(const Condition& condition) const noexcept;
    [[nodiscard]] static std::array<FamilyPhase, familyCount> familiesOf(const Phases& phases) noexcept;

    /// Writes the segment in unit scale.
    void sketch(const Moment& moment, const Condition& condition,
                std::span<float, segmentSamples> segment) const noexcept;
    /// The same with parameters that are known; of the moment only phases, previous waveform and noise count.
    void sketch(const Moment& moment, const SegmentParameters& parameters,
                std::span<float, segmentSamples> segment) const noexcept;
    /// Writes what the refining graph sees, one channel after the other: the segment, the impulses that drove it, and
    /// the cosines and then the sines of the first five harmonics, summed over the families.
    void enter(const Moment& moment, const Condition& condition,
               std::span<float, networkInputChannels * segmentSamples> networkInput) const noexcept;

private:
    struct Pulses;
    [[nodiscard]] ReflectionFilter filterOf(const HiddenLayers::Activations& activations) const noexcept;
    void begin(const Moment& moment, const SegmentParameters& parameters, std::span<float, segmentSamples> segment,
               std::span<float, segmentSamples> impulses, Pulses* pulses) const noexcept;

    HiddenLayers hidden_;
    OutputLayers outputs_;
    TailImpulses impulses_;
};

}  // namespace haptoflow::skeleton
