#include <gtest/gtest.h>

#include <vector>

#include "dsp/denormals.hpp"
#include "dsp/gate.hpp"
#include "dsp/limiter.hpp"
#include "dsp/rate_warp.hpp"
#include "dsp/splice.hpp"
#include "dsp/waveform_resampler.hpp"
#include "support/counting_new.hpp"
#include "test_signals.hpp"

namespace haptoflow::dsp {
namespace {

using Samples = std::span<float>;
using Input = std::span<const float>;

static_assert(noexcept(std::declval<WaveformResampler&>().process(Input{}, Samples{})));
static_assert(noexcept(std::declval<RateWarp&>().process(Input{}, Samples{})));
static_assert(noexcept(std::declval<Gate&>().process(Samples{})));
static_assert(noexcept(std::declval<SoftLimiter&>().processScaled(Samples{})));
static_assert(noexcept(std::declval<LevelSmoother&>().process(Samples{})));
static_assert(noexcept(std::declval<Splice&>().begin(Input{}, Input{}, 4)));

TEST(AllocationTest, ACompleteCallbackAllocatesNothing) {
    const std::vector<float> waveform = testing::whiteNoise(4000, 100.0, 61);
    std::vector<float> warped(200);
    std::vector<float> output(4800);
    WaveformResampler resampler(47999.97);
    RateWarp warp;
    Gate gate(48000.0);
    LevelSmoother smoother(2000.0);
    SoftLimiter limiter;
    Splice splice;

    const std::size_t before = haptoflow::testing::allocationCount();
    for (int block = 0; block < 10; ++block) {
        const ScopedFlushDenormals flush;
        warp.setTargetRatio(block % 2 == 0 ? 3.0 : 1.0);
        const std::size_t needed = resampler.inputNeeded(output.size() / 2);
        const Samples block2kHz = Samples(warped).first(needed);
        warp.process(Input(waveform).first(warp.inputNeeded(needed)), block2kHz);
        splice.begin(waveform, block2kHz, 4);
        block2kHz[0] = splice.next(waveform[0], block2kHz[0]);
        smoother.setTarget(block % 2 == 0 ? 0.2F : 0.9F);
        smoother.process(block2kHz);
        resampler.process(block2kHz, Samples(output).first(output.size() / 2));
        gate.open();
        gate.process(output);
        limiter.scale(output);
        limiter.processScaled(output);
        resampler.reset();
        warp.reset();
    }
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);

    const std::vector<float> proof(10);
    EXPECT_GT(haptoflow::testing::allocationCount(), before) << "the counter does not count";
}

}  // namespace
}  // namespace haptoflow::dsp
