#include "engine/offline_renderer.hpp"

#include "engine/contact_follower.hpp"
#include "engine/material.hpp"
#include "engine/range_law.hpp"
#include "engine/seed_retrieval.hpp"
#include "engine/voice.hpp"
#include "inference/gaussian_noise.hpp"
#include "inference/inference_error.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace haptoflow::engine {
namespace {

// A contact state that is not followed by another within this time is stale: the stylus is gone.
constexpr double staleSeconds = 0.1;

class Recorder final : public WaveformSink {
public:
    void played(std::int64_t start, std::span<const float> samplesMps2) noexcept override {
        if (samples_.empty()) {
            origin_ = start;
        }
        samples_.insert(samples_.end(), samplesMps2.begin(), samplesMps2.end());
    }
    [[nodiscard]] std::vector<float> take() noexcept { return std::move(samples_); }
    [[nodiscard]] std::int64_t origin() const noexcept { return origin_; }

private:
    std::vector<float> samples_;
    std::int64_t origin_ = 0;
};

class OfflineRenderer {
public:
    OfflineRenderer(const model::ModelFile& model, inference::SegmentGenerator& generator,
                    const OfflineSettings& settings)
        : model_(model),
          generator_(generator),
          settings_(settings),
          voice_(settings.outputRateHz, settings.fullScaleMps2),
          leadSamples_(static_cast<std::int64_t>(std::ceil(settings.leadMs * inference::waveformRateHz / 1000.0))) {
        voice_.setSink(&recorder_);
    }

    OfflineRender run(std::span<const ContactState> states, const RenderProgress& progress) {
        const double startSeconds = states.empty() ? 0.0 : states.front().timeSeconds;
        double previousSeconds = startSeconds;
        for (std::size_t i = 0; i < states.size(); ++i) {
            ContactState state = states[i];
            result_.sanitised += sanitise(state);
            const double nowSeconds = std::max(state.timeSeconds, previousSeconds);
            if (nowSeconds - previousSeconds > staleSeconds) {
                renderUntil(previousSeconds + staleSeconds - startSeconds);
                voice_.release();
            }
            renderUntil(nowSeconds - startSeconds);
            follow(state);
            previousSeconds = nowSeconds;
            if (progress) {
                progress(static_cast<double>(i + 1) / static_cast<double>(states.size()));
            }
        }
        voice_.release();
        renderUntil(previousSeconds - startSeconds + settings_.tailSeconds);
        finish();
        return std::move(result_);
    }

private:
    void renderUntil(double seconds) {
        const auto end = static_cast<std::size_t>(std::llround(seconds * settings_.outputRateHz));
        const std::size_t begin = result_.samples.size();
        if (end <= begin) {
            return;
        }
        const std::uint64_t uncovered = voice_.timeline().uncoveredSamples();
        const bool sounding = follower_.sliding();
        result_.samples.resize(end);
        voice_.render(std::span(result_.samples).subspan(begin));
        if (sounding && voice_.timeline().uncoveredSamples() > uncovered) {
            ++result_.underruns;
        }
    }

    void follow(const ContactState& state) {
        switch (follower_.update(state)) {
            case ContactAction::rest:
                result_.skipped += state.touching ? 1U : 0U;
                break;
            case ContactAction::release:
                voice_.release();
                break;
            case ContactAction::onset:
                begin(state);
                advance(state);
                break;
            case ContactAction::slide:
                // The stream was silenced by a gap in the updates: it has to begin anew.
                if (voice_.isSilent()) {
                    begin(state);
                }
                advance(state);
                break;
        }
    }

    inference::SegmentRequest request(const Material& material, const RangedMotion& ranged) const {
        return {.embedding = material.embedding, .motion = ranged.motion, .previous = history_, .noise = noise_};
    }

    void begin(const ContactState& state) {
        const Material material = resolveMaterial(model_, state.material);
        const RangedMotion ranged = applyRangeLaw(model_.header(), material, state.velocityMps, state.forceNewtons);
        voice_.setRangeLaw(ranged.levelGain, ranged.readingRate);
        const auto seed = retrieveSeed(model_, material.dominantLabel, ranged.motion);
        float levelMps2 = 0.0F;
        const std::array requests{request(material, ranged)};
        try {
            generator_.levels(requests, std::span(&levelMps2, 1));
        } catch (const inference::InferenceError&) {
            ++result_.failures;
        }
        voice_.onset(seed, levelMps2);
        ++result_.onsets;
    }

    void advance(const ContactState& state) {
        const Material material = resolveMaterial(model_, state.material);
        const RangedMotion ranged = applyRangeLaw(model_.header(), material, state.velocityMps, state.forceNewtons);
        voice_.setRangeLaw(ranged.levelGain, ranged.readingRate);
        // Read faster, the head passes more of the waveform in the same lead time.
        const std::int64_t start = voice_.timeline().head() +
                                   static_cast<std::int64_t>(static_cast<double>(leadSamples_) * ranged.readingRate);
        voice_.timeline().history(start, history_);
        inference::fillStandardNormal({.seed = settings_.seed, .voice = 0, .segment = segmentCount_}, noise_);
        ++segmentCount_;
        const auto began = std::chrono::steady_clock::now();
        const std::array requests{request(material, ranged)};
        try {
            generator_.generate(requests, segment_);
        } catch (const inference::InferenceError&) {
            // Nothing is published; the running segment goes on to its end and fades there.
            ++result_.failures;
            return;
        }
        const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
        result_.inferenceMs.push_back(spent.count());
        const std::int64_t takeOver = voice_.commit(start, segment_);
        if (takeOver >= 0) {
            result_.seams.push_back(takeOver);
        }
    }

    void finish() {
        for (std::int64_t& seam : result_.seams) {
            seam -= recorder_.origin();
        }
        result_.waveformMps2 = recorder_.take();
        result_.seamStatistics = measureSeams(result_.waveformMps2, result_.seams, dsp::Splice::maximumLength);
        result_.nonFinite = voice_.limiter().nonFiniteCount();
        result_.limited = voice_.limiter().limitedCount();
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

    const model::ModelFile& model_;
    inference::SegmentGenerator& generator_;
    OfflineSettings settings_;
    Voice voice_;
    Recorder recorder_;
    ContactFollower follower_;
    std::int64_t leadSamples_;
    std::uint64_t segmentCount_ = 0;
    std::array<float, inference::segmentSamples> history_{};
    std::array<float, inference::segmentSamples> noise_{};
    std::array<float, inference::segmentSamples> segment_{};
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
