#pragma once

#include "dsp/limiter.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/effect.hpp"
#include "engine/contact_state.hpp"
#include "engine/seam_statistics.hpp"
#include "inference/segment_generator.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {

struct OfflineSettings {
    double outputRateHz = 48000.0;
    /// Time from a contact state to the first sample generated from it; replaces the lead that a live voice estimates.
    double leadMs = 8.0;
    /// Key of all noise: the same model, states and seed give the same samples.
    std::uint64_t seed = 1;
    float fullScaleMps2 = dsp::SoftLimiter::defaultFullScaleMps2;
    /// Time rendered after the last state; longer if effects still sound.
    double tailSeconds = 0.1;
    /// Profile of the actuator to compensate; null for no compensation.
    std::shared_ptr<const effects::ActuatorProfile> actuator = nullptr;
    /// 0 to 0.5.
    double delaySeconds = 0.0;
    /// True to make the vibration audible on loudspeakers: see effects::Listen.
    bool listens = false;
    /// Registered in this order after the model's labels.
    std::vector<model::MaterialFile> materials{};
};

/// Statistics of a render. Their size does not depend on the length of the render.
struct OfflineFigures {
    SeamStatistics seamStatistics;
    /// Output samples, at outputRateHz.
    std::uint64_t outputSamples = 0;
    std::uint64_t segments = 0;
    /// Wall time of a segment's inference, within 0.1 %.
    double inferenceMsMedian = 0.0;
    double inferenceMsP99 = 0.0;
    /// Touches in the states, and the number of those whose samples are all zero.
    std::uint64_t touches = 0;
    std::uint64_t silentTouches = 0;
    std::uint64_t onsets = 0;
    std::uint64_t skipped = 0;
    std::uint64_t failures = 0;
    std::uint64_t underruns = 0;
    std::uint64_t sketched = 0;
    std::uint64_t sanitised = 0;
    std::uint64_t nonFinite = 0;
    std::uint64_t limited = 0;
    /// By effects::EffectKind, without the texture: impacts and edges that sounded, and samples that each effect
    /// processed.
    std::array<std::uint64_t, effects::effectKinds> effectEvents{};
    std::array<std::uint64_t, effects::effectKinds> effectSamples{};
    /// RMS in m/s^2 of the limiter's output over the samples that are not zero.
    double rmsMps2 = 0.0;
    /// Largest magnitude of the output, +-1.
    double peak = 0.0;
};

/// Receives a render piece by piece.
class OfflineSink {
public:
    virtual ~OfflineSink() = default;
    /// Output, +-1 at outputRateHz.
    virtual void output(std::span<const float> samples) = 0;
    /// The waveform that was played (2 kHz, m/s^2), before range law, resampling, gate and limiter.
    virtual void waveform(std::span<const float> samplesMps2) = 0;
};

/// A contact state and when it is published; a live voice takes each state at the time of the call.
struct TimedContactState : ContactState {
    double timeSeconds = 0.0;
};

/// Returns the next contact state, in the order of time; nothing at the end.
using ContactStateSource = std::function<std::optional<TimedContactState>()>;

/// Renders contact states without threads, with the same voice and generator as live. The first state is time
/// 0 of the output. Memory does not grow with the length. Throws std::invalid_argument for settings out of range,
/// model::MaterialMismatch, and what `next` and `sink` throw.
OfflineFigures renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                             const ContactStateSource& next, const OfflineSettings& settings, OfflineSink& sink);

/// A complete render in memory.
struct OfflineRender : OfflineFigures {
    /// Output, +-1 at outputRateHz.
    std::vector<float> samples;
    /// The waveform that was played (2 kHz, m/s^2).
    std::vector<float> waveformMps2;
};

/// Renders `states` into memory.
[[nodiscard]] OfflineRender renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                                          std::span<const TimedContactState> states, const OfflineSettings& settings);

}  // namespace haptoflow::engine
