#include "bench/measurements.hpp"

#include "bench/distribution.hpp"
#include "bench/real_time_device.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

namespace haptoflow::bench {
namespace {

using Voices = std::vector<std::shared_ptr<engine::LiveVoice>>;

/// Sliding voices of one engine and as many untouched ones, rendered and timed separately.
class SlidingAndSilentVoices {
public:
    SlidingAndSilentVoices(const Subjects& subjects, std::size_t voices, bool hasWorker)
        : hand_(*subjects.model), engine_(subjects.standardEngine(hasWorker)), order_(subjects.seed) {
        for (std::size_t voice = 0; voice < voices; ++voice) {
            sliding_.push_back(engine_->addVoice(outputRateHz));
            silent_.push_back(engine_->addVoice(outputRateHz));
        }
    }

    /// Publishes a state for every voice; the speeds vary between a tenth and a half of the recorded range.
    void publish(double seconds) {
        for (std::size_t voice = 0; voice < sliding_.size(); ++voice) {
            const auto phase = static_cast<double>(voice);
            const double speedShare = 0.3 + 0.2 * std::sin(3.0 * seconds + phase);
            engine_->publish(*sliding_[voice], hand_.sliding(1, voice % hand_.labelCount(), speedShare));
            engine_->publish(*silent_[voice], Hand::lifted(0));
        }
    }

    void step() { engine_->step(); }

    /// Renders one block of each kind of voice, in random order, and records both times, also those of the first
    /// blocks.
    void render(std::span<float> block) {
        std::array<double, 2> seconds{};
        const std::size_t first = order_() % 2;
        for (const std::size_t kind : {first, 1 - first}) {
            seconds.at(kind) = secondsOf([&] {
                for (const auto& voice : kind == 0 ? sliding_ : silent_) {
                    voice->renderer.render(block, outputRateHz);
                }
            });
        }
        ++blocks_;
        slidingSeconds_.push_back(seconds[0]);
        silentSeconds_.push_back(seconds[1]);
    }

    [[nodiscard]] nlohmann::ordered_json figures() const {
        if (slidingSeconds_.empty()) {
            throw MeasurementError(
                "the simulated device was called too rarely to be measured: the machine is too busy");
        }
        std::uint64_t underruns = 0;
        for (const auto& voice : sliding_) {
            const engine::VoiceCounters& counters = voice->channels.counters;
            if (counters.onsets == 0) {
                throw MeasurementError("a voice that should slide was silent: its callback was not measured");
            }
            underruns += counters.underruns;
        }
        const double blockMicroseconds = DeviceShape{}.blockSeconds() * microseconds;
        nlohmann::ordered_json figures = toJson(distributionOf(slidingSeconds_), microseconds);
        nlohmann::ordered_json percent;
        for (const char* rank : {"p50", "p99", "worst"}) {
            percent[rank] = rounded(100.0 * figures[rank].get<double>() / blockMicroseconds);
        }
        figures["percent_of_block"] = percent;
        figures["silence"] = toJson(distributionOf(silentSeconds_), microseconds);
        figures["ratio"] = ratioOf(figures["p50"].get<double>(), figures["silence"]["p50"].get<double>());
        figures["underruns"] = underruns;
        return figures;
    }

    /// Number of blocks rendered so far; any thread may call this.
    [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }
    void reserve(std::size_t blocks) {
        slidingSeconds_.reserve(blocks);
        silentSeconds_.reserve(blocks);
    }

private:
    Hand hand_;
    std::unique_ptr<engine::LiveEngine> engine_;
    Voices sliding_;
    Voices silent_;
    std::minstd_rand order_;
    std::atomic<std::size_t> blocks_{0};
    std::vector<double> slidingSeconds_;
    std::vector<double> silentSeconds_;
};

nlohmann::ordered_json measureHot(const Subjects& subjects, std::size_t voices, std::size_t blocks) {
    SlidingAndSilentVoices voicePairs(subjects, voices, false);
    voicePairs.reserve(blocks);
    std::vector<float> block(defaultBlockFrames);
    simulateBlocks(
        blocks,
        [&](double now) {
            voicePairs.publish(now);
            voicePairs.step();
        },
        [&] { voicePairs.render(block); });
    return voicePairs.figures();
}

nlohmann::ordered_json measurePaced(const Subjects& subjects, std::size_t voices, double seconds) {
    const DeviceShape shape;
    const auto wanted = static_cast<std::size_t>(std::ceil(seconds / shape.blockSeconds()));
    // A machine that is busy with other work needs more time for the same number of blocks.
    const double maximumSeconds = 1.0 + 5.0 * static_cast<double>(wanted) * shape.blockSeconds();
    SlidingAndSilentVoices voicePairs(subjects, voices, true);
    voicePairs.reserve(static_cast<std::size_t>(maximumSeconds / shape.blockSeconds()) + 1);
    const double start = nowSeconds();
    RealTimeDevice device(shape, maximumSeconds, [&voicePairs](std::span<float> block) { voicePairs.render(block); });
    for (int update = 1; voicePairs.blocks() < wanted && nowSeconds() < start + maximumSeconds; ++update) {
        voicePairs.publish(nowSeconds() - start);
        sleepUntil(start + update / updateRateHz);
    }
    const std::size_t lateCalls = device.finish().lateCalls;
    nlohmann::ordered_json figures = voicePairs.figures();
    figures["late_calls"] = lateCalls;
    return figures;
}

}  // namespace

nlohmann::ordered_json measureCallback(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::size_t voices : plan.callbackVoices) {
        nlohmann::ordered_json row{{"voices", voices}};
        row.update(measureHot(subjects, voices, plan.callbackBlocks()));
        row["paced"] = measurePaced(subjects, voices, plan.callbackPacedSeconds());
        rows.push_back(std::move(row));
        advance(static_cast<double>(rows.size()) / static_cast<double>(plan.callbackVoices.size()));
    }
    return {{"callback_us", rows}};
}

}  // namespace haptoflow::bench
