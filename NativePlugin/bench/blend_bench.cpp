#include "bench/measurements.hpp"

#include "bench/distribution.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace haptoflow::bench {
namespace {

constexpr std::array<std::size_t, 3> measuredCounts{1, 2, engine::MaterialBlend::capacity};
// Blocks of 5.3 ms that cover the time between two contact states, rounded up.
constexpr std::size_t blocksOfUpdate = 3;

/// One voice on a blend of several materials, with its own engine.
class BlendedVoice {
public:
    BlendedVoice(const Subjects& subjects, std::size_t count)
        : count_(count),
          hand_(*subjects.model),
          engine_(subjects.standardEngine(false)),
          voice_(engine_->addVoice(outputRateHz)) {}

    void update(std::span<float> block) {
        const engine::ContactState state = blended();
        publishSeconds_.push_back(secondsOf([&] { engine_->publish(*voice_, state); }));
        for (std::size_t index = 0; index < blocksOfUpdate; ++index) {
            const double taken = secondsOf([&] { voice_->renderer.render(block, outputRateHz); });
            callbackSeconds_.push_back(taken);
            if (index == 0) {
                // The worker learns only now that the callback runs.
                updateSeconds_.push_back(secondsOf([&] { engine_->step(); }));
            }
        }
    }
    /// Discards the measurements so far: the caches were cold for the first states.
    void warmedUp() {
        publishSeconds_.clear();
        callbackSeconds_.clear();
        updateSeconds_.clear();
    }

    [[nodiscard]] nlohmann::ordered_json figures() const {
        if (voice_->channels.counters.inferences == 0) {
            throw MeasurementError("no segment was generated for a sliding blend: it was not measured");
        }
        return {{"materials", count_},
                {"publish_us", toJson(distributionOf(publishSeconds_), microseconds)},
                {"ms_per_update", toJson(distributionOf(updateSeconds_), milliseconds)},
                {"worker_percent", rounded(workerPercent())},
                {"callback_us", toJson(distributionOf(callbackSeconds_), microseconds)}};
    }

private:
    /// Share of one core. About every fourth update balances the blend, which does not show in the median.
    [[nodiscard]] double workerPercent() const {
        const double spent = std::accumulate(updateSeconds_.begin(), updateSeconds_.end(), 0.0);
        return 100.0 * spent * updateRateHz / static_cast<double>(updateSeconds_.size());
    }
    [[nodiscard]] engine::ContactState blended() const {
        engine::ContactState state = hand_.sliding(1, 0);
        state.material = {};
        for (std::size_t place = 0; place < count_; ++place) {
            state.material.add(hand_.label(place % hand_.labelCount()), 1.0F);
        }
        return state;
    }

    std::size_t count_;
    Hand hand_;
    std::unique_ptr<engine::LiveEngine> engine_;
    std::shared_ptr<engine::LiveVoice> voice_;
    std::vector<double> publishSeconds_;
    std::vector<double> callbackSeconds_;
    std::vector<double> updateSeconds_;
};

}  // namespace

nlohmann::ordered_json measureBlends(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    constexpr std::size_t warmUpUpdates = 5;
    std::deque<BlendedVoice> voices;
    for (const std::size_t count : measuredCounts) {
        voices.emplace_back(subjects, count);
    }
    std::vector<float> block(defaultBlockFrames);
    std::array<std::size_t, measuredCounts.size()> order{0, 1, 2};
    std::minstd_rand random(static_cast<std::uint32_t>(subjects.seed));
    const std::size_t updates = plan.blendUpdates();
    for (std::size_t update = 0; update < updates + warmUpUpdates; ++update) {
        std::ranges::shuffle(order, random);
        for (const std::size_t index : order) {
            voices[index].update(block);
        }
        if (update + 1 == warmUpUpdates) {
            std::ranges::for_each(voices, &BlendedVoice::warmedUp);
        }
        advance(static_cast<double>(update) / static_cast<double>(updates + warmUpUpdates));
    }
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const BlendedVoice& voice : voices) {
        nlohmann::ordered_json row = voice.figures();
        const nlohmann::ordered_json one = rows.empty() ? row : rows.front();
        for (const char* figure : {"publish_us", "ms_per_update", "callback_us"}) {
            row[figure]["ratio"] = ratioOf(row[figure]["p50"].get<double>(), one[figure]["p50"].get<double>());
        }
        row["worker_ratio"] = ratioOf(row["worker_percent"].get<double>(), one["worker_percent"].get<double>());
        rows.push_back(std::move(row));
    }
    return {{"blends", rows}};
}

}  // namespace haptoflow::bench
