#include "bench/measurements.hpp"

#include "bench/distribution.hpp"
#include "bench/machine.hpp"
#include "bench/real_time_device.hpp"
#include "inference/segment_generator.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::bench {
namespace {

constexpr int roundCount = 4;

/// Counts the runs and requests of another generator.
class CountingGenerator final : public inference::SegmentGenerator {
public:
    explicit CountingGenerator(std::unique_ptr<inference::SegmentGenerator> behind) : behind_(std::move(behind)) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        runs.fetch_add(1, std::memory_order_relaxed);
        behind_->generate(requests, segments);
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        runs.fetch_add(1, std::memory_order_relaxed);
        behind_->levels(requests, levelsMps2);
    }

    /// Any thread may read these.
    std::atomic<std::uint64_t> runs{0};

private:
    std::unique_ptr<inference::SegmentGenerator> behind_;
};

struct Busy {
    double cpuSeconds = 0.0;
    double wallSeconds = 0.0;

    [[nodiscard]] double percent() const { return rounded(100.0 * cpuSeconds / wallSeconds); }
};

/// Runs two threads in real time: a device that calls `render`, and this thread, which calls `update`.
template <typename Render, typename Update>
void pass(double seconds, Busy& busy, Render render, Update update) {
    const double cpuBefore = processCpuSeconds();
    const double start = nowSeconds();
    {
        const RealTimeDevice device(DeviceShape{}, 2.0 * seconds, render);
        int count = 0;
        do {
            update();
            ++count;
            sleepUntil(start + count / updateRateHz);
        } while (nowSeconds() < start + seconds);
    }
    busy.wallSeconds += nowSeconds() - start;
    busy.cpuSeconds += processCpuSeconds() - cpuBefore;
}

}  // namespace

nlohmann::ordered_json measureIdle(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    auto counting = std::make_unique<CountingGenerator>(subjects.generator(*subjects.model, subjects.standard(), 1));
    const CountingGenerator& counted = *counting;
    const auto engine = subjects.engineWith(std::move(counting), true);
    const auto voice = engine->addVoice(outputRateHz);
    // Creating the engine runs the network for levels.
    const std::uint64_t runsBefore = counted.runs;
    const std::uint64_t wakesBefore = engine->statistics().wakes;
    Busy idle;
    Busy reference;
    const double seconds = plan.idleSeconds() / roundCount;
    for (int round = 0; round < roundCount; ++round) {
        pass(
            seconds, reference, [](std::span<float> block) { std::ranges::fill(block, 0.0F); }, [] {});
        pass(
            seconds, idle, [&voice](std::span<float> block) { voice->renderer.render(block, outputRateHz); },
            [&] { engine->publish(*voice, Hand::lifted(0)); });
        advance((round + 1.0) / roundCount);
    }
    return {{"idle",
             {{"inferences", counted.runs - runsBefore},
              {"cpu_percent", idle.percent()},
              {"without_engine_cpu_percent", reference.percent()},
              {"ratio", ratioOf(idle.percent(), reference.percent())},
              {"worker_wakes", engine->statistics().wakes - wakesBefore},
              {"updates", voice->channels.counters.updates.load()},
              {"frames", voice->channels.counters.renderedFrames.load()}}}};
}

}  // namespace haptoflow::bench
