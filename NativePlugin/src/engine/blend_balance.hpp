#pragma once

#include "engine/contact_state.hpp"
#include "engine/rib_phase.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::engine {

/// What a blend consists of, for the worker. Empty for a single material.
struct BlendParts {
    static constexpr std::size_t capacity = MaterialBlend::capacity;
    struct Part {
        /// Shares of all parts sum to 1.
        float share = 0.0F;
        std::array<float, inference::embeddingSize> embedding{};
    };
    std::array<Part, capacity> parts{};
    std::size_t count = 0;

    [[nodiscard]] std::span<const Part> all() const noexcept { return std::span(parts).first(count); }
};

/// Keeps the level of a blend between those of its materials. A network was taught materials, not blends of them: it is
/// up to 2 dB louder or softer than it was asked to be, by other amounts for the blend than for its parts. While a
/// voice plays a blend, its parts are generated along with it, unheard and a quarter as often, and the blend gets the
/// gain that makes it as much too loud as they are, on average. Worker thread.
class BlendBalance {
public:
    /// Samples from one segment of the parts to the next.
    static constexpr std::int64_t stepSamples = 100;

    /// `seed` and `voice` key the parts' noise.
    BlendBalance(std::uint64_t seed, std::uint32_t voice) noexcept : seed_(seed), voice_(voice) {}

    /// What the voice plays from now on, at a motion; `sample` is where its next segment takes over.
    void follow(const BlendParts& blend, const std::array<float, 3>& motion, std::int64_t sample) noexcept;
    /// Adds what has to be generated now, if anything. The requests view this object until `take`.
    void request(std::vector<inference::SegmentRequest>& requests);
    [[nodiscard]] std::size_t requested() const noexcept { return requested_; }
    /// The requested segments, one after the other.
    void take(std::span<const float> segments) noexcept;
    /// Weighs in a segment of the blend that was asked for at `levelMps2`, and gives it the gain.
    void level(std::span<float, inference::segmentSamples> segmentMps2, float levelMps2) noexcept;

private:
    /// A mean square of what should be 1, over the newest seconds.
    class RunningPower {
    public:
        void add(double power, double seconds) noexcept;
        [[nodiscard]] double logarithm() const noexcept;

    private:
        double seconds_ = 0.0;
        double mean_ = 1.0;
    };
    struct Shadow {
        BlendParts::Part part;
        RibTurns phase{};
        std::array<float, inference::segmentSamples> previous{};
        std::array<float, inference::segmentSamples> noise{};
        RunningPower power;
    };

    /// What is known of a part; nothing yet of a new one.
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
