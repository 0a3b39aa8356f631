#pragma once

#include "dsp/level_smoother.hpp"
#include "dsp/limiter.hpp"
#include "dsp/rate_warp.hpp"
#include "dsp/tone_filter.hpp"
#include "engine/output_stage.hpp"
#include "engine/waveform_timeline.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::engine {

/// Sees what a voice plays, in waveform time, after tone and before any gain. Called from `Voice::render`: it must not
/// block.
class WaveformSink {
public:
    WaveformSink() = default;
    WaveformSink(const WaveformSink&) = delete;
    WaveformSink& operator=(const WaveformSink&) = delete;
    virtual ~WaveformSink() = default;
    virtual void played(std::int64_t start, std::span<const float> samplesMps2) noexcept = 0;
    /// A segment takes over at that sample.
    virtual void tookOver(std::int64_t sample) noexcept = 0;
};

/// One stylus tip's signal: timeline, tone, level, reading rate, output rate, gate, blows and signal, strength,
/// processors, limiter, in this order.
///
/// While the texture's gate is closed nothing is read: the waveform clock stands still. Where no effect sounds either,
/// `render` writes zeros.
/// Everything here is bounded, allocates nothing (but for construction) and waits for nothing; one thread.
class Voice {
public:
    /// Throws std::invalid_argument for a rate outside 8-192 kHz or a full scale that is not above 0.
    Voice(double outputRateHz, float fullScaleMps2);

    /// Touch-down, or sliding resumed: the second half of the seed sounds with the next sample, the first half is its
    /// past.
    void onset(std::span<const float, WaveformTimeline::seedSamples> seedMps2) noexcept;
    /// See WaveformTimeline::commit.
    std::int64_t commit(std::int64_t start, std::span<const float, inference::segmentSamples> segment) noexcept;
    /// Lift-off: the texture is silent within 5 ms, whatever else happens; effects sound on to their end.
    void release() noexcept { output_->gate.close(); }
    /// Everything is silent within 5 ms, and stays so until `allowEffects`.
    void stop() noexcept;
    /// Effects may sound. Changes nothing while they may already.
    void allowEffects() noexcept { output_->effects.open(); }
    /// A blow with the next sample; `allowEffects` comes first.
    void strikeImpact(double speedMps, const effects::ImpactResponse& response) noexcept;
    void strikeEdge(double speedMps, const effects::ImpactResponse& response) noexcept;
    /// The signal begins with the next sample, as `effects().setSignal` has set it; `allowEffects` comes first.
    void beginSignal() noexcept;
    [[nodiscard]] EffectStage& effects() noexcept { return output_->effects; }
    /// See EffectStage::exchange.
    void exchangeProcessors(std::unique_ptr<Processors> fresh) noexcept;
    [[nodiscard]] const EffectFigures& effectFigures() const noexcept { return figures_; }
    /// Silent at the end of the block that `out` is, whatever its length: a straight line down to zero over it, and
    /// what was committed is dropped.
    void renderStop(std::span<float> out) noexcept;
    /// What the range law asks for; both glide.
    void setRangeLaw(double levelGain, double readingRate) noexcept;

    /// Null for none. Another tone takes over within 10 ms; what sounds next out of silence has it at once.
    void setTone(const dsp::ToneKernel* kernel) noexcept;

    /// Gain of the output before the limiter, 0 to 1; glides while the voice sounds. Set while it is silent, it holds
    /// from the first sample that sounds.
    void setStrength(float strength) noexcept;
    /// Largest magnitude of the output, 0 to 1, at once: where the limiter's curve ends.
    void setCeiling(float ceiling) noexcept { limiter_.setCeiling(ceiling); }

    /// Writes the next samples, +-1.
    void render(std::span<float> out) noexcept;

    [[nodiscard]] double outputRateHz() const noexcept { return output_->rateHz; }
    /// Goes over to another output rate; the voice must be silent. Returns the stage that was in use, for another
    /// thread to delete.
    [[nodiscard]] std::unique_ptr<OutputStage> exchangeOutput(std::unique_ptr<OutputStage> output) noexcept;

    /// True while nothing sounds and nothing is read.
    [[nodiscard]] bool isSilent() const noexcept { return isTextureSilent() && output_->effects.isIdle(); }
    [[nodiscard]] const WaveformTimeline& timeline() const noexcept { return timeline_; }
    [[nodiscard]] const dsp::SoftLimiter& limiter() const noexcept { return limiter_; }
    /// Null for none. Must outlive the voice or be taken away.
    void setSink(WaveformSink* sink) noexcept { sink_ = sink; }

private:
    static constexpr std::size_t blockSamples = EffectStage::blockSamples;

    void noteEvent(effects::EffectKind kind) noexcept;
    [[nodiscard]] bool isTextureSilent() const noexcept { return output_->gate.isClosed(); }
    void produce(std::span<float> out) noexcept;
    void readWaveform(std::span<float> out) noexcept;
    void applyTone(std::span<float> samplesMps2) noexcept;
    void prime() noexcept;

    std::unique_ptr<OutputStage> output_;
    WaveformTimeline timeline_;
    dsp::ToneFilter tone_;
    dsp::LevelSmoother level_;
    dsp::RateWarp warp_;
    dsp::SoftLimiter limiter_;
    double readingRate_ = 1.0;
    EffectFigures figures_;
    WaveformSink* sink_ = nullptr;
};

}  // namespace haptoflow::engine
