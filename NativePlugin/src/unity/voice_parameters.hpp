#pragma once

#include "unity/audio_effect_sdk.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::unity {

/// The voice that an effect plays, and its output channel.
struct Route {
    /// Place of the voice among the process's voices.
    std::size_t place = 0;
    /// HAPTOFLOW_ALL_CHANNELS or an index.
    std::int32_t channel = 0;

    [[nodiscard]] bool operator==(const Route&) const = default;
};

/// Parameters of the effect, which the mixer's inspector, snapshots and exposed parameters set. The main thread writes
/// and the audio thread reads, both without waiting.
class VoiceParameters {
public:
    /// Size of a value's text with the zero byte. Unity does not document the size of its buffer; FMOD, which it uses,
    /// guarantees this much.
    static constexpr std::size_t textSize = 16;
    static constexpr std::size_t parameterCount = 3;

    VoiceParameters() noexcept;

    /// Definitions in the order of the indices. They live as long as the library.
    [[nodiscard]] static std::span<AudioParameterDefinition> definitions() noexcept;

    /// Clamps `value` to the parameter's range and rounds places and channels. Returns false, without a change, for an
    /// invalid index or NaN.
    [[nodiscard]] bool set(int index, float value) noexcept;
    /// Either pointer may be null; `text` has room for textSize bytes. Returns false for an invalid index.
    [[nodiscard]] bool get(int index, float* value, char* text) const noexcept;

    [[nodiscard]] float strength() const noexcept;
    [[nodiscard]] Route route() const noexcept;

private:
    static_assert(std::atomic<float>::is_always_lock_free);

    std::array<std::atomic<float>, parameterCount> values_;
};

}  // namespace haptoflow::unity
