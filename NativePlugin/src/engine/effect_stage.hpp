#pragma once

#include "dsp/gate.hpp"
#include "effects/delay.hpp"
#include "effects/effect.hpp"
#include "effects/exposure_guard.hpp"
#include "effects/signal.hpp"
#include "effects/strikes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::engine {

/// What the stages of a voice have done; every number only grows.
struct EffectFigures {
    struct OfKind {
        /// How often a stage of this kind was made ready for the voice.
        std::uint64_t prepared = 0;
        /// Blocks, samples and time that it ran for.
        std::uint64_t runs = 0;
        std::uint64_t samples = 0;
        std::uint64_t nanoseconds = 0;
        /// Blows of an impact or an edge, rebounds not counted; of a signal, how often it began to sound.
        std::uint64_t events = 0;
    };
    std::array<OfKind, effects::effectKinds> kinds{};
    /// Increases whenever one of the numbers may have increased, so that a reader can skip figures without a change.
    std::uint64_t changes = 0;

    /// The numbers of one kind, for the caller to increase.
    [[nodiscard]] OfKind& of(effects::EffectKind kind) noexcept {
        ++changes;
        return kinds[static_cast<std::size_t>(kind)];
    }
};

/// Stages that change the whole signal, made together for one output rate; null where a voice does not ask for one.
struct Processors {
    /// ProcessorSettings::version when they were made.
    std::uint64_t version = 0;
    double rateHz = 0.0;
    std::unique_ptr<effects::Delay> delay;
    std::unique_ptr<effects::Effect> compensation;
    std::unique_ptr<effects::ExposureGuard> exposureGuard;
    /// Unused: the voice had a delay already, and keeps that one with the signal in it.
    std::unique_ptr<effects::Delay> spareDelay;
};

/// What stands behind the texture of a voice, for one output rate: blows and a signal are added, then the whole goes
/// through the processors that the voice asks for, then through a gate that silences everything at once.
///
/// A stage without anything to do is not run: a voice that asks for no effect is rendered as if there were none, bit
/// for bit. Audio thread but for construction.
class EffectStage {
public:
    /// Throws std::invalid_argument for a rate that Gate refuses.
    explicit EffectStage(double outputRateHz);

    /// A blow with the next sample.
    void strikeImpact(double speedMps, const effects::ImpactResponse& response) noexcept;
    void strikeEdge(double speedMps, const effects::ImpactResponse& response) noexcept;
    /// See effects::Signal. Whoever closes this stage need not end the signal: it goes with everything else.
    void setSignal(const effects::SignalSettings& settings) noexcept { signal_.set(settings); }
    void beginSignal() noexcept { signal_.begin(); }
    void endSignal() noexcept { signal_.end(); }
    [[nodiscard]] bool isSignalOn() const noexcept { return signal_.isOn(); }
    /// Hands over within 10 ms of sound from the present processors to these. Not while an earlier hand-over is under
    /// way, nor before `takeUsed` has returned what that one left behind.
    void exchange(std::unique_ptr<Processors> fresh) noexcept;
    [[nodiscard]] bool isHandingOver() const noexcept { return fadeLeft_ > 0; }
    /// At once; for a voice that is silent.
    void finishHandOver() noexcept { fadeLeft_ = 0; }
    /// What a guard has measured goes on in this stage's, where it has one: another rate is the same hand.
    void adoptExposure(const EffectStage& before) noexcept;
    void setDelaySeconds(double seconds) noexcept;
    /// By how much what goes in now comes later; 0 without a delay.
    [[nodiscard]] double delaySeconds() const noexcept;
    void setActuatorGain(double gain) noexcept;
    /// Time that passed without `process`.
    void passSilence(std::size_t samples) noexcept;
    /// Null for none. Any thread may read its report while the stage lives.
    [[nodiscard]] const effects::ExposureGuard* exposureGuard() const noexcept { return guard_.get(); }
    /// What the last hand-over has left behind; null while it is under way and where there was none.
    [[nodiscard]] std::unique_ptr<Processors> takeUsed() noexcept;

    /// Lets sound through, from silence at once; and stops everything within 5 ms.
    void open() noexcept;
    void close() noexcept;

    /// Adds the landings and edges that still ring, and the signal, to the next samples, at most 64, in m/s^2. Call
    /// `process` with the same samples afterwards.
    void addSources(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    /// Works on the next samples in place, m/s^2: at most 64.
    void process(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    /// Silent at once, without a ramp.
    void reset() noexcept;

    /// True while silence going in comes out as silence.
    [[nodiscard]] bool isIdle() const noexcept;
    /// Version of the processors that sound, or will once the hand-over is done; 0 for none.
    [[nodiscard]] std::uint64_t version() const noexcept;

    static constexpr std::size_t blockSamples = 64;

private:
    [[nodiscard]] bool areSourcesIdle() const noexcept;
    void runSources(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    void runProcessors(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    void runGuard(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    void passGate(std::span<float> samplesMps2) noexcept;
    void settleDelay() noexcept;
    [[nodiscard]] bool hasProcessors() const noexcept;

    effects::Strikes impact_;
    effects::Strikes edge_;
    effects::Signal signal_;
    dsp::Gate gate_;
    std::unique_ptr<Processors> processors_;
    std::unique_ptr<Processors> leaving_;
    // These two stay in use when processors are exchanged: a new delay would lose the signal in the old one, and a new
    // guard what the old one has measured. While a delay is being switched on or off, it is faded as a member of its
    // Processors.
    std::unique_ptr<effects::Delay> delay_;
    std::unique_ptr<effects::ExposureGuard> guard_;
    std::size_t fadeSamples_;
    std::size_t fadeLeft_ = 0;
    // The gain of a guard that was switched off, which glides to 1 over this many more samples.
    float leftGain_ = 1.0F;
    std::size_t leftGainSamples_ = 0;
};

}  // namespace haptoflow::engine
