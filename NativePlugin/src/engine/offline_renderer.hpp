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
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {

struct OfflineSettings {
    double outputRateHz = 48000.0;
    /// From a contact state to the first sample generated from it; stands for the live engine's measured lead.
    double leadMs = 8.0;
    /// Key of all noise: same model, states and seed give the same samples.
    std::uint64_t seed = 1;
    float fullScaleMps2 = dsp::SoftLimiter::defaultFullScaleMps2;
    /// Rendered after the last state, for what still has to fade; longer where effects ring on.
    double tailSeconds = 0.1;
    /// What the render is compensated for; null for nothing.
    std::shared_ptr<const effects::ActuatorProfile> actuator = nullptr;
    /// 0 to 0.5.
    double delaySeconds = 0.0;
    /// Registered in this order, behind the model's labels.
    std::vector<model::MaterialFile> materials{};
};

/// What a render's own engine counted and measured. Fixed in size, however long the render.
struct OfflineFigures {
    SeamStatistics seamStatistics;
    /// Output samples, at outputRateHz.
    std::uint64_t outputSamples = 0;
    std::uint64_t segments = 0;
    /// Wall time of a segment's inference, within 0.1 %.
    double inferenceMsMedian = 0.0;
    double inferenceMsP99 = 0.0;
    /// Touches in the states, and those of them without a sample that is not zero.
    std::uint64_t touches = 0;
    std::uint64_t silentTouches = 0;
    std::uint64_t onsets = 0;
    std::uint64_t skipped = 0;
    std::uint64_t failures = 0;
    std::uint64_t underruns = 0;
    std::uint64_t sanitised = 0;
    std::uint64_t nonFinite = 0;
    std::uint64_t limited = 0;
    /// By effects::EffectKind: landings and edges that sounded, and samples that each effect worked on. Of the texture
    /// there is nothing here.
    std::array<std::uint64_t, effects::effectKinds> effectEvents{};
    std::array<std::uint64_t, effects::effectKinds> effectSamples{};
    /// RMS in m/s^2 while the voice sounds, as it leaves the limiter.
    double rmsMps2 = 0.0;
    /// Largest magnitude of the output, +-1.
    double peak = 0.0;
};

/// Where a render goes, piece by piece.
class OfflineSink {
public:
    OfflineSink() = default;
    OfflineSink(const OfflineSink&) = delete;
    OfflineSink& operator=(const OfflineSink&) = delete;
    virtual ~OfflineSink() = default;
    /// Output, +-1 at outputRateHz.
    virtual void output(std::span<const float> samples) = 0;
    /// What was played in waveform time (2 kHz, m/s^2), before level law, resampling, gate and limiter.
    virtual void waveform(std::span<const float> samplesMps2) = 0;
};

/// The next contact state, times ascending; nothing at the end.
using ContactStateSource = std::function<std::optional<ContactState>()>;

/// Renders contact states (the first is time 0 of the output) without threads, by the same voice, timeline and
/// generator as live, in memory that does not grow with the length. Throws std::invalid_argument for settings out of
/// range, model::MaterialMismatch, and what `next` and `sink` throw.
OfflineFigures renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                             const ContactStateSource& next, const OfflineSettings& settings, OfflineSink& sink);

/// A render that is kept whole.
struct OfflineRender : OfflineFigures {
    /// Output, +-1 at outputRateHz.
    std::vector<float> samples;
    /// What was played in waveform time (2 kHz, m/s^2).
    std::vector<float> waveformMps2;
};

/// The same of states that are there already.
[[nodiscard]] OfflineRender renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                                          std::span<const ContactState> states, const OfflineSettings& settings);

}  // namespace haptoflow::engine
