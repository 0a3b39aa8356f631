#pragma once

#include "engine/live_voice.hpp"
#include "engine/offline_renderer.hpp"
#include "fake_generators.hpp"
#include "inference/skeleton_generator.hpp"
#include "support/wave_measures.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace haptoflow::engine::testing {

/// Records the played waveform and the samples at which segments took over.
class WaveformRecorder final : public WaveformSink {
public:
    void played(std::int64_t start, std::span<const float> samplesMps2) noexcept override {
        if (samples.empty()) {
            origin = start;
        }
        samples.insert(samples.end(), samplesMps2.begin(), samplesMps2.end());
    }
    void tookOver(std::int64_t sample) noexcept override { seams.push_back(sample - origin); }

    std::vector<float> samples;
    std::vector<std::int64_t> seams;
    std::int64_t origin = 0;
};

struct DeviceSettings {
    double rateHz = 48000.0;
    std::size_t blockFrames = 256;
    /// Number of blocks that the device requests in immediate succession.
    std::size_t burstBlocks = 1;
    double updateHz = 72.0;
    /// Time from the worker's check of the contact to the arrival of the segment, as a function of the time of the
    /// check.
    std::function<double(double)> latencySeconds = [](double) { return 0.002; };
    float fullScaleMps2 = 60.0F;
    std::optional<std::int64_t> fixedLeadSamples = std::nullopt;
    /// Publisher and callback read the simulated clock, as they read the steady one in a real engine.
    bool readsClock = false;
};

/// Main thread, worker and audio device of one voice on a simulated clock, with the rates and latencies of the
/// settings. Deterministic; other tests use real threads.
class SimulatedDevice {
public:
    /// The contact state at a time; nothing if no state is published then.
    using Hand = std::function<std::optional<ContactState>(double)>;

    SimulatedDevice(const model::ModelFile& model, inference::SegmentGenerator& generator,
                    const DeviceSettings& settings = {})
        : library(model, generator),
          settings_(settings),
          generator_(generator),
          voice_(library, workerAlive, voiceSettings(model, settings)) {
        voice_.renderer.setSink(&waveform);
        if (settings.readsClock) {
            voice_.channels.isRealTime = true;
            voice_.channels.clock = []() noexcept { return clockSeconds; };
        }
    }

    /// Runs for a time and appends the played samples to `output`.
    void run(double seconds, const Hand& hand) {
        const double end = now_ + seconds;
        const double period = static_cast<double>(settings_.blockFrames * settings_.burstBlocks) / settings_.rateHz;
        while (true) {
            const double next = std::min({nextUpdate_, nextBlock_, pending_ ? pendingAt_ : end});
            if (next >= end) {
                break;
            }
            now_ = next;
            clockSeconds = next;
            if (pending_ && pendingAt_ <= next) {
                deliver();
            } else if (nextUpdate_ <= next) {
                nextUpdate_ += 1.0 / settings_.updateHz;
                if (const auto state = hand(now_)) {
                    publish(*state);
                }
            } else {
                nextBlock_ += period;
                for (std::size_t block = 0; block < settings_.burstBlocks; ++block) {
                    renderBlock();
                }
                if (voice_.planner.mustPoll()) {
                    wakeWorker();
                }
            }
        }
        now_ = end;
    }

    void publish(const ContactState& state) {
        voice_.publisher.publish(state);
        wakeWorker();
    }

    void renderBlock() {
        const std::size_t begin = output.size();
        output.resize(begin + settings_.blockFrames);
        voice_.renderer.render(std::span(output).subspan(begin), settings_.rateHz);
    }

    void setRate(double rateHz) { settings_.rateHz = rateHz; }
    void setBlock(std::size_t frames) { settings_.blockFrames = frames; }

    [[nodiscard]] const VoiceCounters& counters() const { return voice_.channels.counters; }
    [[nodiscard]] VoiceControls& controls() { return voice_.channels.controls; }
    [[nodiscard]] LiveVoice& voice() { return voice_; }
    [[nodiscard]] double now() const { return now_; }

    std::atomic<bool> workerAlive{true};
    MaterialLibrary library;
    std::vector<float> output;
    WaveformRecorder waveform;

private:
    static inline double clockSeconds = 0.0;

    static LiveVoiceSettings voiceSettings(const model::ModelFile& model, const DeviceSettings& settings) {
        LiveVoiceSettings voice;
        voice.planner.fixedLeadSamples = settings.fixedLeadSamples;
        voice.outputRateHz = settings.rateHz;
        voice.fullScaleMps2 = settings.fullScaleMps2;
        voice.isRealTime = false;
        voice.native = skeleton::readNativeParts(model);
        return voice;
    }

    void wakeWorker() {
        voice_.planner.serveOutputRate();
        // The worker is busy; the wake-up waits until the run has ended.
        if (pending_) {
            missedWake_ = true;
            return;
        }
        if (!workerAlive || !voice_.planner.wake()) {
            return;
        }
        if (!generate(voice_.planner.request())) {
            return;
        }
        pending_ = true;
        pendingAt_ = now_ + settings_.latencySeconds(now_);
    }

    bool generate(const inference::SegmentRequest& request) {
        try {
            generator_.generate(std::span(&request, 1), segment_);
        } catch (const std::exception&) {
            voice_.planner.fail();
            return false;
        }
        return true;
    }

    void deliver() {
        pending_ = false;
        while (voice_.planner.deliver(segment_)) {
            if (!generate(voice_.planner.request())) {
                break;
            }
        }
        if (missedWake_) {
            missedWake_ = false;
            wakeWorker();
        }
    }

    DeviceSettings settings_;
    inference::SegmentGenerator& generator_;
    LiveVoice voice_;
    double now_ = 0.0;
    double nextUpdate_ = 0.0;
    double nextBlock_ = 0.0;
    bool pending_ = false;
    bool missedWake_ = false;
    double pendingAt_ = 0.0;
    std::array<float, inference::segmentSamples> segment_{};
};

/// Contact state of a tip that slides over the model's first label.
inline ContactState sliding(float speedMps = 0.1F, float forceNewtons = 1.0F) {
    ContactState state;
    state.touching = true;
    state.touchCounter = 1;
    state.velocityMps = {speedMps, 0.0F};
    state.forceNewtons = forceNewtons;
    state.material.add(0, 1.0F);
    return state;
}

/// The same of a tip on a plane at a known place along x.
inline ContactState slidingAt(double metres, float speedMps = 0.1F) {
    ContactState state = sliding(speedMps);
    state.hasPlace = 1;
    state.surfaceSeed = 3;
    state.placeMetres = {static_cast<float>(metres), 0.0F, 0.0F};
    state.firstAxis = {1.0F, 0.0F, 0.0F};
    state.secondAxis = {0.0F, 1.0F, 0.0F};
    return state;
}

inline ContactState lifted(std::uint32_t touchCounter = 1) {
    ContactState state;
    state.touchCounter = touchCounter;
    return state;
}

using haptoflow::testing::largestStep;
using haptoflow::testing::levelDecibels;
using haptoflow::testing::peak;

/// A state for each update of a hand, the first at time 0.
template <typename Hand>
std::vector<TimedContactState> statesOf(double seconds, Hand hand, double updateHz = 72.0) {
    std::vector<TimedContactState> states;
    for (double t = 0.0; t < seconds; t = static_cast<double>(states.size()) / updateHz) {
        states.push_back({hand(t), t});
    }
    return states;
}

/// A model with a skeleton, which sounds by itself from the first block on.
struct SoundingModel {
    model::ModelFile model = calmSkeletonModel();
    inference::SkeletonGenerator generator{skeleton::readNativeParts(model), 4};
};

/// The small model and a network that continues a tone, for the simulated device.
class DeviceTest : public ::testing::Test {
protected:
    static std::optional<ContactState> slide(double) { return sliding(); }
    static ContactState touch(std::uint32_t number, std::uint32_t label = 0) {
        ContactState state = sliding();
        state.touchCounter = number;
        state.material.labels[0] = label;
        return state;
    }
    /// The output from a frame on.
    static std::span<const float> from(const SimulatedDevice& device, std::size_t frame) {
        return std::span<const float>(device.output).subspan(frame);
    }
    static void renderBlocks(SimulatedDevice& device, int count) {
        for (int block = 0; block < count; ++block) {
            device.renderBlock();
        }
    }
    static const EffectCounters& of(const SimulatedDevice& device, effects::EffectKind kind) {
        return device.counters().effects[static_cast<std::size_t>(kind)];
    }

    model::ModelFile model_ = smallModel();
    FakeGenerator tone_{continueTone};
};

}  // namespace haptoflow::engine::testing
