#include "engine/offline_renderer.hpp"

#include "dsp/splice.hpp"
#include "engine/live_voice.hpp"
#include "engine/material_library.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptoflow::engine {
namespace {

constexpr double maximumTailSeconds = 3.0;

/// Collects the waveform that the voice plays until `hand` passes it on. Keeps its buffers.
class Recorder final : public WaveformSink {
public:
    void played(std::int64_t start, std::span<const float> samplesMps2) noexcept override {
        if (!origin_) {
            origin_ = start;
        }
        samples_.insert(samples_.end(), samplesMps2.begin(), samplesMps2.end());
    }
    void tookOver(std::int64_t sample) noexcept override { seams_.push_back(sample); }

    /// Passes on everything collected since the last call.
    void hand(OfflineSink& sink, SeamMeter& meter) {
        if (!origin_) {
            return;
        }
        for (const std::int64_t seam : seams_) {
            meter.addSeam(seam - *origin_);
        }
        meter.addSamples(samples_);
        if (!samples_.empty()) {
            sink.waveform(samples_);
        }
        seams_.clear();
        samples_.clear();
    }

private:
    std::vector<float> samples_;
    std::vector<std::int64_t> seams_;
    std::optional<std::int64_t> origin_;
};

/// Counts touches and those without any sound.
class TouchCounter {
public:
    void begin(std::uint32_t touch) noexcept {
        if (touch_ != touch) {
            end();
            touch_ = touch;
            ++touches_;
        }
    }
    void noteSound() noexcept { hasSound_ = true; }
    void end() noexcept {
        silent_ += touch_ && !hasSound_ ? 1U : 0U;
        touch_.reset();
        hasSound_ = false;
    }
    [[nodiscard]] std::uint64_t touches() const noexcept { return touches_; }
    [[nodiscard]] std::uint64_t silent() const noexcept { return silent_; }

private:
    std::optional<std::uint32_t> touch_;
    bool hasSound_ = false;
    std::uint64_t touches_ = 0;
    std::uint64_t silent_ = 0;
};

class KeepingSink final : public OfflineSink {
public:
    explicit KeepingSink(OfflineRender& render) : render_(render) {}
    void output(std::span<const float> samples) override {
        render_.samples.insert(render_.samples.end(), samples.begin(), samples.end());
    }
    void waveform(std::span<const float> samplesMps2) override {
        render_.waveformMps2.insert(render_.waveformMps2.end(), samplesMps2.begin(), samplesMps2.end());
    }

private:
    OfflineRender& render_;
};

LiveVoiceSettings voiceSettings(const model::ModelFile& model, const OfflineSettings& settings) {
    LiveVoiceSettings voice;
    voice.planner.seed = settings.seed;
    voice.planner.fixedLeadSamples = LeadEstimator::samplesOf(settings.leadMs);
    voice.outputRateHz = settings.outputRateHz;
    voice.fullScaleMps2 = settings.fullScaleMps2;
    voice.isRealTime = false;
    voice.native = skeleton::readNativeParts(model);
    return voice;
}

/// Runs publisher, renderer and planner of a live voice in turn on one thread.
class OfflineRenderer {
public:
    OfflineRenderer(const model::ModelFile& model, inference::SegmentGenerator& generator,
                    const OfflineSettings& settings, OfflineSink& sink)
        : generator_(generator),
          settings_(settings),
          sink_(sink),
          library_(model, generator),
          voice_(library_, workerAlive_, voiceSettings(model, settings)) {
        for (const model::MaterialFile& material : settings.materials) {
            (void)library_.add(material, [&generator]() -> inference::LevelEstimator& { return generator; });
        }
        voice_.renderer.setSink(&recorder_);
        addProcessors();
    }

    OfflineFigures run(const ContactStateSource& next) {
        std::optional<double> startSeconds;
        double nowSeconds = 0.0;
        ContactState liftedOff;
        while (std::optional<TimedContactState> state = next()) {
            figures_.sanitised += sanitise(*state);
            if (!std::isfinite(state->timeSeconds)) {
                state->timeSeconds = 0.0;
                ++figures_.sanitised;
            }
            nowSeconds = std::max(state->timeSeconds, startSeconds ? nowSeconds : state->timeSeconds);
            startSeconds = startSeconds.value_or(nowSeconds);
            renderUntil(nowSeconds - *startSeconds);
            if (state->touching != 0) {
                touches_.begin(state->touchCounter);
            }
            publish(*state);
            liftedOff.touchCounter = state->touchCounter;
        }
        publish(liftedOff);
        const double endSeconds = nowSeconds - startSeconds.value_or(nowSeconds) + settings_.tailSeconds;
        renderUntil(endSeconds);
        renderTail(endSeconds, liftedOff);
        touches_.end();
        finish();
        return figures_;
    }

private:
    void renderUntil(double seconds) {
        const auto end = static_cast<std::uint64_t>(std::llround(seconds * settings_.outputRateHz));
        if (end <= figures_.outputSamples) {
            return;
        }
        block_.resize(static_cast<std::size_t>(end - figures_.outputSamples));
        voice_.renderer.render(block_, settings_.outputRateHz);
        figures_.outputSamples = end;
        measure();
        sink_.output(block_);
        recorder_.hand(sink_, seams_);
    }

    /// Renders until effects that still sound (an impact, a compensation, a delay) have ended. Publishes lifted states,
    /// because a stale voice would be silenced.
    void renderTail(double seconds, const ContactState& liftedOff) {
        constexpr double stepSeconds = 0.05;
        const double maximumSeconds = seconds + maximumTailSeconds;
        while (seconds < maximumSeconds && voice_.channels.audible.load(std::memory_order_relaxed)) {
            publish(liftedOff);
            seconds += stepSeconds;
            renderUntil(seconds);
        }
    }

    RoundResult infer() {
        LiveVoice* const voices[] = {&voice_};
        return round_.run(voices, generator_);
    }

    void addProcessors() {
        if (settings_.actuator == nullptr && !(settings_.delaySeconds > 0.0) && !settings_.listens) {
            return;
        }
        voice_.channels.controls.delaySeconds = settings_.delaySeconds;
        voice_.channels.changeProcessors([this](ProcessorSettings& processors) {
            processors.actuator = settings_.actuator;
            processors.hasDelay = settings_.delaySeconds > 0.0;
            processors.listenFullScaleMps2 = settings_.listens ? static_cast<double>(settings_.fullScaleMps2) : 0.0;
            return true;
        });
        // The renderer states its rate, the planner makes the processors, and the renderer takes them.
        voice_.renderer.render({}, settings_.outputRateHz);
        (void)infer();
        voice_.renderer.render({}, settings_.outputRateHz);
    }

    void measure() {
        for (const float sample : block_) {
            squares_ += static_cast<double>(sample) * static_cast<double>(sample);
            sounding_ += sample != 0.0F ? 1U : 0U;
            figures_.peak = std::max(figures_.peak, static_cast<double>(std::abs(sample)));
        }
        if (std::ranges::any_of(block_, [](float sample) { return sample != 0.0F; })) {
            touches_.noteSound();
        }
    }

    void publish(const ContactState& state) {
        voice_.publisher.publish(state);
        // An empty block makes the renderer begin the stream, which the planner needs.
        voice_.renderer.render({}, settings_.outputRateHz);
        const RoundResult round = infer();
        if (round.segments > 0) {
            inferenceMs_.add(static_cast<float>(round.milliseconds / static_cast<double>(round.segments)));
        }
    }

    void finish() {
        figures_.seamStatistics = seams_.statistics();
        figures_.segments = inferenceMs_.count();
        figures_.inferenceMsMedian = static_cast<double>(inferenceMs_.valueAtShare(0.5));
        figures_.inferenceMsP99 = static_cast<double>(inferenceMs_.valueAtShare(0.99));
        figures_.touches = touches_.touches();
        figures_.silentTouches = touches_.silent();
        const VoiceCounters& counters = voice_.channels.counters;
        figures_.onsets = counters.onsets;
        figures_.skipped = counters.skipped;
        figures_.failures = counters.failures;
        figures_.underruns = counters.underruns;
        figures_.sketched = counters.sketched;
        figures_.nonFinite = counters.nonFiniteSamples;
        figures_.limited = counters.limitedSamples;
        for (std::size_t kind = 0; kind < effects::effectKinds; ++kind) {
            figures_.effectEvents[kind] = counters.effects[kind].events;
            figures_.effectSamples[kind] = counters.effects[kind].samples;
        }
        if (sounding_ > 0) {
            figures_.rmsMps2 =
                std::sqrt(squares_ / static_cast<double>(sounding_)) * static_cast<double>(settings_.fullScaleMps2);
        }
    }

    inference::SegmentGenerator& generator_;
    OfflineSettings settings_;
    OfflineSink& sink_;
    std::atomic<bool> workerAlive_{true};
    MaterialLibrary library_;
    LiveVoice voice_;
    Recorder recorder_;
    InferenceRound round_;
    SeamMeter seams_{dsp::Splice::maximumLength};
    ValueHistogram inferenceMs_;
    TouchCounter touches_;
    std::vector<float> block_;
    double squares_ = 0.0;
    std::uint64_t sounding_ = 0;
    OfflineFigures figures_;
};

}  // namespace

OfflineFigures renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                             const ContactStateSource& next, const OfflineSettings& settings, OfflineSink& sink) {
    if (!(settings.leadMs >= 0.0 && settings.leadMs <= LeadEstimator::maximumMs)) {
        throw std::invalid_argument("lead is " + std::to_string(settings.leadMs) + " ms; expected 0 to 50 ms");
    }
    if (!(settings.tailSeconds >= 0.0 && settings.tailSeconds <= 10.0)) {
        throw std::invalid_argument("tail is " + std::to_string(settings.tailSeconds) + " s; expected 0 to 10 s");
    }
    if (!(settings.delaySeconds >= 0.0 && settings.delaySeconds <= effects::Delay::maximumSeconds)) {
        throw std::invalid_argument("delay is " + std::to_string(settings.delaySeconds) + " s; expected 0 to 0.5 s");
    }
    return OfflineRenderer(model, generator, settings, sink).run(next);
}

OfflineRender renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                            std::span<const TimedContactState> states, const OfflineSettings& settings) {
    OfflineRender render;
    KeepingSink sink(render);
    const ContactStateSource next = [&states]() -> std::optional<TimedContactState> {
        if (states.empty()) {
            return std::nullopt;
        }
        const TimedContactState state = states.front();
        states = states.subspan(1);
        return state;
    };
    static_cast<OfflineFigures&>(render) = renderOffline(model, generator, next, settings, sink);
    return render;
}

}  // namespace haptoflow::engine
