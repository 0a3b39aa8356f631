#pragma once

#include "dsp/limiter.hpp"
#include "engine/contact_state.hpp"
#include "engine/seam_statistics.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
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
    /// Rendered after the last state, for what still has to fade.
    double tailSeconds = 0.1;
};

struct OfflineRender {
    /// Output, +-1 at outputRateHz.
    std::vector<float> samples;
    /// What was played in waveform time (2 kHz, m/s^2), before level law, resampling, gate and limiter.
    std::vector<float> waveformMps2;
    /// Take-over samples of all segments but those after an onset, as indices into waveformMps2.
    std::vector<std::int64_t> seams;
    SeamStatistics seamStatistics;
    /// Wall time of each segment's inference.
    std::vector<double> inferenceMs;
    std::uint64_t onsets = 0;
    std::uint64_t skipped = 0;
    std::uint64_t failures = 0;
    std::uint64_t underruns = 0;
    std::uint64_t sanitised = 0;
    std::uint64_t nonFinite = 0;
    std::uint64_t limited = 0;
    /// RMS in m/s^2 while the voice sounds, as it leaves the limiter.
    double rmsMps2 = 0.0;
    /// Largest magnitude of `samples`.
    double peak = 0.0;
};

/// Called with the share that is done, 0 to 1.
using RenderProgress = std::function<void(double)>;

/// Renders contact states (times ascending, the first is time 0 of the output) without threads, by the same voice,
/// timeline and generator as live. Throws std::invalid_argument for settings out of range.
[[nodiscard]] OfflineRender renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                                          std::span<const ContactState> states, const OfflineSettings& settings,
                                          const RenderProgress& progress = {});

}  // namespace haptoflow::engine
