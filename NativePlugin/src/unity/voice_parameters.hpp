#pragma once

#include "unity/audio_effect_sdk.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::unity {

/// Which voice goes where.
struct Route {
    /// Of the voice, among the process's voices.
    std::size_t place = 0;
    /// HAPTOFLOW_ALL_CHANNELS or an index.
    std::int32_t channel = 0;

    [[nodiscard]] bool operator==(const Route&) const = default;
};

/// What the mixer's inspector, snapshots and exposed parameters set. The main thread writes, the audio thread reads;
/// neither waits.
class VoiceParameters {
public:
    /// With the zero byte. Unity says nothing of the size of its buffer; the engine below it, FMOD, promises this much.
    static constexpr std::size_t textSize = 16;
    static constexpr std::size_t parameterCount = 3;

    VoiceParameters() noexcept;

    /// In the order of their indices; lives as long as the library.
    [[nodiscard]] static std::span<AudioParameterDefinition> definitions() noexcept;

    /// Limits to the parameter's range, places and channels to whole numbers. False for an index that is none and for
    /// NaN: nothing is changed.
    [[nodiscard]] bool set(int index, float value) noexcept;
    /// Either pointer may be null; `text` has room for textSize. False for an index that is none.
    [[nodiscard]] bool get(int index, float* value, char* text) const noexcept;

    [[nodiscard]] float strength() const noexcept;
    [[nodiscard]] Route route() const noexcept;

private:
    static_assert(std::atomic<float>::is_always_lock_free);

    std::array<std::atomic<float>, parameterCount> values_;
};

}  // namespace haptoflow::unity
