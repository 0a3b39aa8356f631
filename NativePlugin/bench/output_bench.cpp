#include "bench/measurements.hpp"

#include "bench/distribution.hpp"
#include "effects/wave_features.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace haptoflow::bench {
namespace {

constexpr double deviceVoiceRateHz = 8000.0;
constexpr double frameSeconds = 1.0 / updateRateHz;

struct OutputKind {
    const char* name;
    double rateHz;
    bool hasLowPass;
    /// Length of a frame of features; 0 for an output that uses the wave itself.
    double featureSeconds;
};

constexpr std::array<OutputKind, 4> kinds{{{"audio", outputRateHz, false, 0.0},
                                           {"controller waveform", deviceVoiceRateHz, true, 0.0},
                                           {"controller parametric", deviceVoiceRateHz, true, 0.005},
                                           {"motor", deviceVoiceRateHz, true, 0.008}}};

/// One voice and the processing of its wave for an output, frame by frame.
class OutputSubject {
public:
    OutputSubject(const OutputKind& kind, engine::LiveEngine& engine)
        : kind_(kind),
          voice_(engine.addVoice(kind.rateHz)),
          decimation_(static_cast<std::size_t>(kind.rateHz / effects::WaveFeatures::sampleRateHz)),
          block_(static_cast<std::size_t>(kind.rateHz * frameSeconds) + 1),
          slow_(block_.size()) {
        if (kind.featureSeconds > 0.0) {
            effects::WaveFeatureOptions options;
            options.frameSeconds = kind.featureSeconds;
            features_.emplace(options);
            frames_.resize(features_->framesWithin(slow_.size()));
        }
    }

    [[nodiscard]] engine::LiveVoice& voice() noexcept { return *voice_; }

    /// Processes everything that is due until `now`, in seconds since the start.
    void frame(double now) {
        const auto due = static_cast<std::uint64_t>(now * kind_.rateHz);
        const std::size_t count = std::min<std::size_t>(block_.size(), due - rendered_);
        rendered_ += count;
        seconds_.push_back(secondsOf([&] { play(std::span(block_).first(count)); }));
    }

    [[nodiscard]] nlohmann::ordered_json figures(const nlohmann::ordered_json& reference) const {
        if (voice_->channels.counters.onsets == 0) {
            throw MeasurementError("a voice that should slide was silent: its output was not measured");
        }
        nlohmann::ordered_json row{{"name", kind_.name}, {"rate_hz", kind_.rateHz}};
        const nlohmann::ordered_json frame = toJson(distributionOf(seconds_), microseconds);
        row.update({{"us_per_frame", frame},
                    {"share_of_frame", rounded(frame["p50"].get<double>() / (frameSeconds * microseconds))}});
        row["ratio"] = reference.is_null()
                           ? nlohmann::ordered_json()
                           : ratioOf(frame["p50"].get<double>(), reference["us_per_frame"]["p50"].get<double>());
        return row;
    }

private:
    void play(std::span<float> block) {
        voice_->renderer.render(block, kind_.rateHz);
        if (!kind_.hasLowPass) {
            return;
        }
        std::size_t count = 0;
        for (const float sample : block) {
            count += decimation_.take(sample, slow_[count]) ? 1 : 0;
        }
        if (features_) {
            (void)features_->process(std::span(slow_).first(count), frames_);
        }
    }

    OutputKind kind_;
    std::shared_ptr<engine::LiveVoice> voice_;
    effects::WaveDecimation decimation_;
    std::optional<effects::WaveFeatures> features_;
    std::vector<effects::WaveFrame> frames_;
    std::vector<float> block_;
    std::vector<float> slow_;
    std::uint64_t rendered_ = 0;
    std::vector<double> seconds_;
};

}  // namespace

nlohmann::ordered_json measureOutputs(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    const Hand hand(*subjects.model);
    const std::unique_ptr<engine::LiveEngine> engine = subjects.standardEngine(false);
    std::vector<std::unique_ptr<OutputSubject>> outputs;
    for (const OutputKind& kind : kinds) {
        outputs.push_back(std::make_unique<OutputSubject>(kind, *engine));
    }
    std::vector<std::size_t> order(outputs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::minstd_rand random(static_cast<std::minstd_rand::result_type>(subjects.seed));
    const std::size_t frames = plan.outputFrames();
    for (std::size_t frame = 1; frame <= frames; ++frame) {
        for (const auto& output : outputs) {
            engine->publish(output->voice(), hand.sliding(1, frame / 72 % hand.labelCount()));
        }
        engine->step();
        std::ranges::shuffle(order, random);
        for (const std::size_t index : order) {
            outputs[index]->frame(static_cast<double>(frame) * frameSeconds);
        }
        advance(static_cast<double>(frame) / static_cast<double>(frames));
    }
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const auto& output : outputs) {
        rows.push_back(output->figures(rows.empty() ? nlohmann::ordered_json() : rows.front()));
    }
    return {{"outputs", rows}};
}

}  // namespace haptoflow::bench
