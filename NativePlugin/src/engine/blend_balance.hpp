#pragma once

#include "engine/contact_state.hpp"
#include "engine/rib_phase.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_header.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::engine {

/// The materials of a blend, for the worker. Empty for a single material.
struct BlendParts {
    static constexpr std::size_t capacity = MaterialBlend::capacity;
    struct Part {
        /// The shares of all parts add up to 1.
        float share = 0.0F;
        std::array<float, inference::embeddingSize> embedding{};
        /// Without length for a material that does not slip.
        model::StickSlip slip{};
        float impulseGain = 1.0F;
    };
    std::array<Part, capacity> parts{};
    std::size_t count = 0;

    [[nodiscard]] std::span<const Part> all() const noexcept { return std::span(parts).first(count); }
};

/// Keeps the level of a blend between the levels of its materials. The network was trained on materials, not on blends;
/// its output is up to 2 dB louder or softer than requested, and the error of a blend differs from that of its parts.
/// While a voice plays a blend, this class also generates its parts, without playing them and a quarter as often. The
/// blend gets the gain that makes its mean level error equal to that of the parts. Worker thread.
class BlendBalance {
public:
    /// Waveform samples between two segments of the parts.
    static constexpr std::int64_t stepSamples = 100;

    /// `seed` and `voice` key the noise of the parts.
    BlendBalance(std::uint64_t seed, std::uint32_t voice) noexcept : seed_(seed), voice_(voice) {}

    /// Sets the blend and the motion of the voice's next segment, which takes over at `sample`.
    void follow(const BlendParts& blend, const std::array<float, 3>& motion, std::int64_t sample) noexcept;
    /// Appends requests for the parts if a step has passed. The requests view this object until `take`.
    void request(std::vector<inference::SegmentRequest>& requests);
    /// Number of requests appended by `request` and not yet taken.
    [[nodiscard]] std::size_t requested() const noexcept { return requested_; }
    /// Takes the requested segments, one after the other.
    void take(std::span<const float> segments) noexcept;
    /// Measures a segment of the blend that was generated for `levelMps2` and applies the gain to it. Returns the gain;
    /// 1 for a single material.
    float level(std::span<float, inference::segmentSamples> segmentMps2, float levelMps2) noexcept;

private:
    /// Mean square, over the last seconds, of a signal with a nominal mean square of 1.
    class RunningPower {
    public:
        void add(double power, double seconds) noexcept;
        [[nodiscard]] double logarithm() const noexcept;

    private:
        double seconds_ = 0.0;
        double mean_ = 1.0;
    };
    /// State of a part that is generated without being played.
    struct Shadow {
        BlendParts::Part part;
        RibCycles phase{};
        double slipPhase = 0.0;
        std::array<float, inference::segmentSamples> previous{};
        std::array<float, inference::segmentSamples> noise{};
        RunningPower power;
    };

    /// The state of a part; a fresh one if the part is new.
    [[nodiscard]] Shadow shadowOf(const BlendParts::Part& part) const noexcept;
    [[nodiscard]] float gain() const noexcept;

    std::uint64_t seed_;
    std::uint32_t voice_;
    std::uint64_t segments_ = 0;
    std::array<Shadow, BlendParts::capacity> shadows_{};
    std::size_t count_ = 0;
    std::array<float, 3> motion_{};
    RunningPower blend_;
    std::int64_t sample_ = 0;
    std::int64_t lastStep_ = 0;
    std::int64_t lastLevelled_ = 0;
    std::size_t requested_ = 0;
};

}  // namespace haptoflow::engine
