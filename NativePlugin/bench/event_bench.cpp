#include "bench/measurements.hpp"

#include "bench/distribution.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::bench {
namespace {

struct EventDevice {
    std::size_t voices;
    std::size_t blockFrames;
    double rateHz;
};

constexpr std::array devices{EventDevice{1, defaultBlockFrames, outputRateHz}, EventDevice{1, 64, 192000.0},
                             EventDevice{16, 128, outputRateHz}};

enum class Kind { ordinary, onset, resume, pause, stop, panic };
constexpr std::array<std::string_view, 6> kindNames{"ordinary", "onset", "resume", "pause", "stop", "panic"};
// Longer than any fade: the blocks that events are compared with come after it.
constexpr double settledSeconds = 0.03;

/// Voices that are touched, paused, resumed, lifted and silenced together; all of their blocks are timed.
class EventVoices {
public:
    EventVoices(const Subjects& subjects, const EventDevice& device)
        : device_(device), hand_(*subjects.model), engine_(subjects.standardEngine(false)), random_(subjects.seed) {
        for (std::size_t voice = 0; voice < device.voices; ++voice) {
            voices_.push_back(engine_->addVoice(device.rateHz));
        }
        block_.resize(device.blockFrames);
    }

    void playTouch() {
        ++touch_;
        publish(true);
        render(Kind::onset);
        settle();
        setPaused(true);
        render(Kind::pause);
        settle();
        setPaused(false);
        publish(true);
        render(Kind::resume);
        settle();
        const bool ends = touch_ % 2 == 0;
        if (ends) {
            publish(false);
        } else {
            for (const auto& voice : voices_) {
                voice->channels.panic();
            }
        }
        render(ends ? Kind::stop : Kind::panic);
        publish(false);
        settle();
    }

    [[nodiscard]] nlohmann::ordered_json figures() const {
        nlohmann::ordered_json row{
            {"voices", device_.voices}, {"block_frames", device_.blockFrames}, {"sample_rate_hz", device_.rateHz}};
        for (std::size_t kind = 0; kind < kindNames.size(); ++kind) {
            if (seconds_.at(kind).empty()) {
                throw MeasurementError("no block of the kind " + std::string(kindNames.at(kind)) + " was measured");
            }
            nlohmann::ordered_json entry = toJson(distributionOf(seconds_.at(kind)), microseconds);
            if (kind > 0) {
                entry["ratio"] = ratioOf(entry["p50"].get<double>(), row["ordinary"]["p50"].get<double>());
            }
            row[std::string(kindNames.at(kind))] = entry;
        }
        return row;
    }

private:
    void publish(bool isTouching) {
        std::uniform_real_distribution<double> speedShare(0.1, 0.9);
        for (std::size_t voice = 0; voice < voices_.size(); ++voice) {
            const std::size_t place = (touch_ + voice) % hand_.labelCount();
            engine_->publish(*voices_[voice],
                             isTouching ? hand_.sliding(touch_, place, speedShare(random_)) : Hand::lifted(touch_));
        }
    }
    void setPaused(bool isPaused) {
        for (const auto& voice : voices_) {
            voice->channels.controls.paused = isPaused;
        }
    }
    void settle() {
        const auto blocks = 1 + static_cast<std::size_t>(settledSeconds * device_.rateHz) / device_.blockFrames;
        for (std::size_t index = 0; index < blocks; ++index) {
            engine_->step();
            const engine::Silence silence = voices_.front()->channels.silence;
            if (silence == engine::Silence::none) {
                render(Kind::ordinary);
            } else {
                renderUntimed();
            }
        }
    }
    void renderUntimed() {
        for (const auto& voice : voices_) {
            voice->renderer.render(block_, device_.rateHz);
        }
    }
    void render(Kind kind) {
        seconds_.at(static_cast<std::size_t>(kind)).push_back(secondsOf([this] { renderUntimed(); }));
    }

    EventDevice device_;
    Hand hand_;
    std::unique_ptr<engine::LiveEngine> engine_;
    std::vector<std::shared_ptr<engine::LiveVoice>> voices_;
    std::mt19937_64 random_;
    std::vector<float> block_;
    std::uint32_t touch_ = 0;
    std::array<std::vector<double>, kindNames.size()> seconds_;
};

}  // namespace

nlohmann::ordered_json measureEventBlocks(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const EventDevice& device : devices) {
        EventVoices eventVoices(subjects, device);
        // Touches end alternately by lift-off and by panic.
        for (std::size_t touch = 0; touch < std::max<std::size_t>(2, plan.events); ++touch) {
            eventVoices.playTouch();
        }
        rows.push_back(eventVoices.figures());
        advance(static_cast<double>(rows.size()) / static_cast<double>(devices.size()));
    }
    return {{"callback_events_us", rows}};
}

}  // namespace haptoflow::bench
