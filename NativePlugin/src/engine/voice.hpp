#pragma once

#include "dsp/gate.hpp"
#include "dsp/limiter.hpp"
#include "dsp/rate_warp.hpp"
#include "dsp/tone_filter.hpp"
#include "engine/effect_stage.hpp"
#include "engine/waveform.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::engine {

/// Receives the waveform that a voice plays, after tone and before any gain. Called from `Voice::render`, so it must
/// not block.
class WaveformSink {
public:
    virtual ~WaveformSink() = default;
    virtual void played(std::int64_t start, std::span<const float> samplesMps2) noexcept = 0;
    /// A correction takes over at `sample`.
    virtual void tookOver(std::int64_t sample) noexcept = 0;
};

/// Where the limiter acts: on the voice, or on a sum that the voice is rendered for.
enum class Limit { voice, sum };

/// The signal of one stylus tip. Its stages in order: waveform, tone, high-pass, range law,
/// reading rate, output rate, gate, contact events and signal, delay, compensation, strength, exposure guard, the gate
/// of all effects, limiter.
///
/// While the texture's gate is closed, the waveform is not read and its clock stands still. If no effect sounds either,
/// `render` writes zeros. Used by one thread. Construction excepted, all functions take bounded time, allocate nothing
/// and wait for nothing.
class Voice {
public:
    /// Counts its effects in `figures`, which must outlive it. `skeleton` is null for a model without one.
    /// Throws std::invalid_argument for a rate outside 8-192 kHz or a full scale that is not above 0.
    Voice(double outputRateHz, float fullScaleMps2, EffectFigures& figures,
          std::shared_ptr<const skeleton::Skeleton> skeleton = nullptr);

    /// Touch-down, or sliding resumed: the stream sounds from the next sample on (see Waveform::begin). A model without
    /// a skeleton has no stream and plays `beginningUnit` instead. If the texture still sounds, nothing begins: the
    /// stream goes on with the new contact.
    void begin(const skeleton::StreamParameters& parameters, double samplesAhead, const skeleton::NoiseKey& key,
               skeleton::Segment beginningUnit) noexcept;
    /// Goes on with another contact from the next sample on.
    void follow(const skeleton::StreamParameters& parameters, double samplesAhead) noexcept {
        waveform_.follow(parameters, samplesAhead);
    }
    /// Samples that an onset would read at once, because they need not wait for the resampler.
    [[nodiscard]] std::size_t samplesReadAhead() const noexcept {
        return isTextureSilent() ? output_->resampler.latencyInputSamples() : 0;
    }
    /// The waveform sample, with its fraction, that the resampler plays with the next output sample.
    [[nodiscard]] double playPosition() const noexcept {
        return static_cast<double>(waveform_.head()) - warp_.samplesAhead() -
               warp_.ratio() * output_->resampler.samplesUntilNext();
    }
    /// True if the stream sounds by itself.
    [[nodiscard]] bool hasSkeleton() const noexcept { return skeleton_ != nullptr; }
    /// Takes a correction of the present stream. Returns the sample at which it takes over, or -1.
    std::int64_t take(const Correction& correction) noexcept;
    /// Lift-off: fades the texture to silence within 5 ms; effects sound to their end.
    void release() noexcept { output_->gate.close(); }
    /// Fades everything to silence within 5 ms; effects stay silent until `allowEffects`.
    void stop() noexcept;
    /// Lets effects sound. Does nothing if they already may.
    void allowEffects() noexcept { output_->effects.open(); }
    /// Starts a contact event, an impact or an edge, with the next sample. Call `allowEffects` before.
    void start(effects::EffectKind kind, double speedMps, const effects::ImpactResponse& response) noexcept;
    /// Goes on with the relief of a contact; see effects::Relief.
    void followRelief(const effects::ReliefContact& contact) noexcept;
    /// See effects::ClipSound. Call `allowEffects` before.
    void startClip(std::span<const float> waveMps2, float gain, bool isLoop) noexcept;
    /// Starts the signal set by `effects().setSignal` with the next sample. Call `allowEffects` before.
    void beginSignal() noexcept;
    [[nodiscard]] EffectStage& effects() noexcept { return output_->effects; }
    /// See EffectStage::exchange.
    void exchangeProcessors(std::unique_ptr<Processors> fresh) noexcept;
    /// Renders a block of any length that fades linearly to silence at its end, and ends the texture.
    void renderStop(std::span<float> out) noexcept;
    /// Sets the range law's gain and reading rate; both change smoothly.
    void setRangeLaw(double levelGain, double readingRate) noexcept;

    /// Sets the tone; null for none. A change takes 10 ms, or takes effect at once while the texture is silent.
    void setTone(const dsp::ToneKernel* kernel) noexcept;

    /// Sets the gain before the limiter, 0 to 1. A change takes 10 ms, or takes effect at once while the voice is
    /// silent.
    void setStrength(float strength) noexcept;
    /// Sets the limiter's ceiling, 0 to 1, at once.
    void setCeiling(float ceiling) noexcept { limiter_.setCeiling(ceiling); }

    /// Writes the next samples, +-1; without limit while `setLimit` says that they are part of a sum.
    void render(std::span<float> out) noexcept;
    void setLimit(Limit limit) noexcept { limit_ = limit; }
    /// Limits a sum of voices that were rendered without limit, and counts its limited samples as this voice's.
    void limitSum(std::span<float> sum, float ceiling) noexcept;

    [[nodiscard]] double outputRateHz() const noexcept { return output_->rateHz; }
    /// Changes to the output stage of another rate; the voice must be silent. Returns the old stage, for another thread
    /// to delete.
    [[nodiscard]] std::unique_ptr<OutputStage> exchangeOutput(std::unique_ptr<OutputStage> output) noexcept;

    /// True while nothing sounds and the waveform is not read.
    [[nodiscard]] bool isSilent() const noexcept { return isTextureSilent() && output_->effects.isIdle(); }
    [[nodiscard]] const Waveform& waveform() const noexcept { return waveform_; }
    [[nodiscard]] const dsp::SoftLimiter& limiter() const noexcept { return limiter_; }
    /// Null for none. The sink must outlive the voice or be removed before.
    void setSink(WaveformSink* sink) noexcept { sink_ = sink; }

private:
    static constexpr std::size_t blockSamples = EffectStage::blockSamples;

    [[nodiscard]] EffectCounters& of(effects::EffectKind kind) noexcept {
        return figures_[static_cast<std::size_t>(kind)];
    }
    void noteEvent(effects::EffectKind kind) noexcept;
    [[nodiscard]] bool isTextureSilent() const noexcept { return output_->gate.isClosed(); }
    void produce(std::span<float> out) noexcept;
    void readWaveform(std::span<float> out) noexcept;
    void applyTone(std::span<float> samplesMps2) noexcept;
    void prime() noexcept;

    std::unique_ptr<OutputStage> output_;
    std::shared_ptr<const skeleton::Skeleton> skeleton_;
    Waveform waveform_;
    dsp::ToneFilter tone_;
    dsp::HighPass highPass_;
    dsp::LevelSmoother level_;
    dsp::RateWarp warp_;
    dsp::SoftLimiter limiter_;
    Limit limit_ = Limit::voice;
    double readingRate_ = 1.0;
    EffectFigures& figures_;
    WaveformSink* sink_ = nullptr;
};

}  // namespace haptoflow::engine
