#include "engine/offline_renderer.hpp"

#include "engine/inference_round.hpp"
#include "engine/live_voice.hpp"
#include "engine/onset_levels.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptoflow::engine {
namespace {

class Recorder final : public WaveformSink {
public:
    void played(std::int64_t start, std::span<const float> samplesMps2) noexcept override {
        if (samples_.empty()) {
            origin_ = start;
        }
        samples_.insert(samples_.end(), samplesMps2.begin(), samplesMps2.end());
    }
    void tookOver(std::int64_t sample) noexcept override { seams_.push_back(sample); }

    [[nodiscard]] std::vector<float> takeSamples() noexcept { return std::move(samples_); }
    /// As indices into the samples.
    [[nodiscard]] std::vector<std::int64_t> takeSeams() noexcept {
        for (std::int64_t& seam : seams_) {
            seam -= origin_;
        }
        return std::move(seams_);
    }

private:
    std::vector<float> samples_;
    std::vector<std::int64_t> seams_;
    std::int64_t origin_ = 0;
};

LiveVoiceSettings voiceSettings(const OfflineSettings& settings) {
    LiveVoiceSettings voice;
    voice.planner.seed = settings.seed;
    voice.planner.fixedLeadSamples =
        static_cast<std::int64_t>(std::ceil(settings.leadMs * inference::waveformRateHz / 1000.0));
    // Every contact state is asked for, however close it follows.
    voice.planner.shortestHopSamples = 0;
    voice.outputRateHz = settings.outputRateHz;
    voice.fullScaleMps2 = settings.fullScaleMps2;
    return voice;
}

/// The three ends of a live voice, taken in turn by one thread.
class OfflineRenderer {
public:
    OfflineRenderer(const model::ModelFile& model, inference::SegmentGenerator& generator,
                    const OfflineSettings& settings)
        : generator_(generator),
          settings_(settings),
          levels_(model, generator),
          voice_(model, levels_, workerAlive_, voiceSettings(settings)) {
        voice_.renderer.setSink(&recorder_);
    }

    OfflineRender run(std::span<const ContactState> states, const RenderProgress& progress) {
        const double startSeconds = states.empty() ? 0.0 : states.front().timeSeconds;
        double nowSeconds = startSeconds;
        for (std::size_t i = 0; i < states.size(); ++i) {
            ContactState state = states[i];
            result_.sanitised += sanitise(state);
            nowSeconds = std::max(state.timeSeconds, nowSeconds);
            renderUntil(nowSeconds - startSeconds);
            publish(state);
            if (progress) {
                progress(static_cast<double>(i + 1) / static_cast<double>(states.size()));
            }
        }
        publish(liftedOff(states));
        renderUntil(nowSeconds - startSeconds + settings_.tailSeconds);
        finish();
        return std::move(result_);
    }

private:
    static ContactState liftedOff(std::span<const ContactState> states) {
        ContactState state;
        state.touchCounter = states.empty() ? 0 : states.back().touchCounter;
        return state;
    }

    void renderUntil(double seconds) {
        const auto end = static_cast<std::size_t>(std::llround(seconds * settings_.outputRateHz));
        const std::size_t begin = result_.samples.size();
        if (end > begin) {
            result_.samples.resize(end);
            voice_.renderer.render(std::span(result_.samples).subspan(begin), settings_.outputRateHz);
        }
    }

    void publish(const ContactState& state) {
        voice_.publisher.publish(state);
        // The callback's end takes note of the contact, so that the worker's end finds its stream begun.
        voice_.renderer.render({}, settings_.outputRateHz);
        LiveVoice* const voices[] = {&voice_};
        const RoundResult round = round_.run(voices, generator_);
        if (round.segments > 0) {
            result_.inferenceMs.push_back(round.milliseconds / static_cast<double>(round.segments));
        }
    }

    void finish() {
        result_.seams = recorder_.takeSeams();
        result_.waveformMps2 = recorder_.takeSamples();
        result_.seamStatistics = measureSeams(result_.waveformMps2, result_.seams, dsp::Splice::maximumLength);
        const VoiceCounters& counters = voice_.channels.counters;
        result_.onsets = counters.onsets;
        result_.skipped = counters.skipped;
        result_.failures = counters.failures;
        result_.underruns = counters.underruns;
        result_.nonFinite = counters.nonFiniteSamples;
        result_.limited = counters.limitedSamples;
        double squares = 0.0;
        std::size_t sounding = 0;
        for (const float sample : result_.samples) {
            squares += static_cast<double>(sample) * static_cast<double>(sample);
            sounding += sample != 0.0F ? 1U : 0U;
            result_.peak = std::max(result_.peak, static_cast<double>(std::abs(sample)));
        }
        if (sounding > 0) {
            result_.rmsMps2 =
                std::sqrt(squares / static_cast<double>(sounding)) * static_cast<double>(settings_.fullScaleMps2);
        }
    }

    inference::SegmentGenerator& generator_;
    OfflineSettings settings_;
    std::atomic<bool> workerAlive_{true};
    OnsetLevels levels_;
    LiveVoice voice_;
    Recorder recorder_;
    InferenceRound round_;
    OfflineRender result_;
};

}  // namespace

OfflineRender renderOffline(const model::ModelFile& model, inference::SegmentGenerator& generator,
                            std::span<const ContactState> states, const OfflineSettings& settings,
                            const RenderProgress& progress) {
    if (!(settings.leadMs >= 0.0 && settings.leadMs <= 50.0)) {
        throw std::invalid_argument("the lead must be 0 to 50 ms");
    }
    if (!(settings.tailSeconds >= 0.0 && settings.tailSeconds <= 10.0)) {
        throw std::invalid_argument("the tail must be 0 to 10 s");
    }
    return OfflineRenderer(model, generator, settings).run(states, progress);
}

}  // namespace haptoflow::engine
