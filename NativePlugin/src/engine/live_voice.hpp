#pragma once

#include "dsp/limiter.hpp"
#include "engine/contact_publisher.hpp"
#include "engine/segment_planner.hpp"
#include "engine/stream_parameters.hpp"
#include "engine/voice_channels.hpp"
#include "engine/voice_renderer.hpp"
#include "inference/segment_generator.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <span>
#include <string>
#include <vector>

namespace haptoflow::engine {

struct LiveVoiceSettings {
    PlannerSettings planner{};
    double outputRateHz = 48000.0;
    float fullScaleMps2 = dsp::SoftLimiter::defaultFullScaleMps2;
    /// VoiceChannels::isRealTime.
    bool isRealTime = true;
    /// The model's skeleton, if it has one.
    skeleton::NativeParts native{};
};

/// The voice of one stylus tip: a publisher for the main thread, a renderer for the audio callback, a planner for the
/// worker, and the channels between them. `library` and `workerAlive` must outlive it.
struct LiveVoice {
    /// Throws std::invalid_argument for settings out of range.
    LiveVoice(const MaterialLibrary& library, const std::atomic<bool>& workerAlive, const LiveVoiceSettings& settings)
        : publisher(library, channels,
                    StreamParameterMaker(settings.native, settings.planner.seed, settings.planner.voice)),
          renderer(channels, workerAlive, settings.outputRateHz, settings.fullScaleMps2,
                   {.seed = settings.planner.seed, .voice = settings.planner.voice}, settings.native.skeleton),
          planner(channels, settings.planner, settings.native.skeleton) {
        channels.isRealTime = settings.isRealTime;
    }

    VoiceChannels channels;
    ContactPublisher publisher;
    VoiceRenderer renderer;
    SegmentPlanner planner;
};

/// Result of one round of inference.
struct RoundResult {
    /// Number of voices that needed a segment; 0 if nothing was run.
    std::size_t voices = 0;
    /// Number of segments that voices got.
    std::size_t segments = 0;
    /// Whether the run of a voice failed, and the message of the newest failure.
    bool failed = false;
    std::string failure;
    /// A voice waits for the callback, so the worker must check again soon.
    bool mustPoll = false;
    double milliseconds = 0.0;
};

/// Generates segments for all voices that need one, in one batch, and then further segments for those that need more
/// than one. Worker thread; keeps its buffers between rounds.
class InferenceRound {
public:
    /// If a batch fails, its voices are run one by one, so that only the voice for which the graph fails gets no
    /// segment.
    RoundResult run(std::span<LiveVoice* const> voices, inference::SegmentGenerator& generator);

private:
    void generate(inference::SegmentGenerator& generator, RoundResult& result);

    std::vector<LiveVoice*> pending_;
    std::vector<inference::SegmentRequest> requests_;
    std::vector<float> segments_;
};

}  // namespace haptoflow::engine
