#pragma once

#include "dsp/limiter.hpp"
#include "engine/contact_publisher.hpp"
#include "engine/segment_planner.hpp"
#include "engine/stream_parameters.hpp"
#include "engine/voice_channels.hpp"
#include "engine/voice_renderer.hpp"
#include "skeleton/skeleton_tensors.hpp"

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

}  // namespace haptoflow::engine
