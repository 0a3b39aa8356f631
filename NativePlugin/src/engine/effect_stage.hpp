#pragma once

#include "dsp/gate.hpp"
#include "dsp/waveform_resampler.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/clip_sound.hpp"
#include "effects/delay.hpp"
#include "effects/effect.hpp"
#include "effects/exposure_guard.hpp"
#include "effects/impacts.hpp"
#include "effects/relief.hpp"
#include "effects/signal.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::engine {

/// Increases a counter that only the calling thread writes.
inline void increase(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
}

/// Counters of one effect of a voice; none ever decreases. The callback writes, any thread reads.
struct EffectCounters {
    /// Number of times that a stage of this kind was prepared for the voice.
    std::atomic<std::uint64_t> prepared{0};
    /// Blocks and samples processed, and the time they took.
    std::atomic<std::uint64_t> runs{0};
    std::atomic<std::uint64_t> samples{0};
    std::atomic<std::uint64_t> nanoseconds{0};
    /// For impact and edge, the number of contact events without rebounds; for a signal and clips, that of starts.
    std::atomic<std::uint64_t> events{0};

    /// Calls `process`, which processes a block of this many samples, and counts it.
    template <typename Process>
    void countRun(std::size_t blockSamples, Process&& process) noexcept {
        const auto began = std::chrono::steady_clock::now();
        process();
        const std::chrono::nanoseconds spent = std::chrono::steady_clock::now() - began;
        increase(runs);
        increase(samples, blockSamples);
        increase(nanoseconds, static_cast<std::uint64_t>(spent.count()));
    }
};

/// The counters of a voice, one for each effects::EffectKind, which is the index.
using EffectFigures = std::array<EffectCounters, effects::effectKinds>;

/// Effects that process the whole signal, made together for one output rate. A null pointer means that the voice does
/// not use the effect.
struct Processors {
    /// ProcessorSettings::version for which they were made.
    std::uint64_t version = 0;
    double rateHz = 0.0;
    std::unique_ptr<effects::Delay> delay;
    std::unique_ptr<effects::Effect> compensation;
    std::unique_ptr<effects::Effect> listen;
    /// Switched off if the voice only had a guard before.
    std::unique_ptr<effects::ExposureGuard> exposureGuard;
    /// Not used: the voice keeps its present delay, which holds the signal.
    std::unique_ptr<effects::Delay> spareDelay;
};

/// The effects of a voice after its texture, for one output rate. Adds contact events and a signal, then applies the
/// voice's processors, then a gate that can silence everything.
///
/// Idle effects do not run: a voice without effects renders the same bits as without this stage. Construction excepted,
/// everything runs on the audio thread.
class EffectStage {
public:
    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit EffectStage(double outputRateHz);

    /// Starts a contact event, an impact or an edge, with the next sample.
    void start(effects::EffectKind kind, double speedMps, const effects::ImpactResponse& response) noexcept {
        (kind == effects::EffectKind::edge ? edge_ : impact_).start(speedMps, response);
    }
    /// See effects::Relief.
    void followRelief(const effects::ReliefContact& contact) noexcept { relief_.follow(contact); }
    void keepRelief(const effects::ReliefMap* map) noexcept { relief_.keep(map); }
    /// See effects::ClipSound.
    [[nodiscard]] effects::ClipSound& clip() noexcept { return clip_; }
    /// See effects::Signal. `close` also ends the signal.
    void setSignal(const effects::SignalSettings& settings) noexcept { signal_.set(settings); }
    void beginSignal() noexcept { signal_.begin(); }
    void endSignal() noexcept { signal_.end(); }
    [[nodiscard]] bool isSignalOn() const noexcept { return signal_.isOn(); }
    /// Starts a crossfade of 10 ms from the present processors to `fresh`. Not allowed during an earlier crossfade, nor
    /// before `takeReplaced` has returned the processors that it replaced.
    void exchange(std::unique_ptr<Processors> fresh) noexcept;
    [[nodiscard]] bool isHandingOver() const noexcept { return fadeRemaining_ > 0; }
    /// Ends the crossfade at once; for a silent voice.
    void finishHandOver() noexcept;
    /// Continues the exposure measured by the guard of `before`, a stage at another rate for the same hand. Does
    /// nothing unless both stages have a guard, be it switched off.
    void adoptExposure(const EffectStage& before) noexcept;
    void setDelaySeconds(double seconds) noexcept;
    /// Delay of the signal; 0 without a delay.
    [[nodiscard]] double delaySeconds() const noexcept;
    void setActuatorGain(double gain) noexcept;
    /// Accounts for time that passed in silence without `process`.
    void passSilence(std::size_t samples) noexcept;
    /// Null if there is none that is switched on. Any thread may read its report during the stage's lifetime.
    [[nodiscard]] const effects::ExposureGuard* exposureGuard() const noexcept {
        return guard_ != nullptr && guard_->isOn() ? guard_.get() : nullptr;
    }
    /// The processors replaced by the last crossfade; null during a crossfade or if there are none.
    [[nodiscard]] std::unique_ptr<Processors> takeReplaced() noexcept;

    /// `open` lets sound through, from silence without a ramp; `close` silences everything within 5 ms.
    void open() noexcept;
    void close() noexcept;

    /// Adds sounding impacts, edges, relief, clip and signal to the next samples, at most 64, in m/s^2. Call `process`
    /// with the same samples afterwards.
    void addSources(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    /// Processes the next samples in place, at most 64, in m/s^2. `strength` acts after delay and compensation and
    /// before the guard, which therefore measures the level that is played.
    void process(std::span<float> samplesMps2, dsp::LevelSmoother& strength, EffectFigures& figures) noexcept;
    /// Silences everything at once, without a ramp.
    void reset() noexcept;

    /// True while silent input gives silent output.
    [[nodiscard]] bool isIdle() const noexcept;
    /// Version of the present processors, or of those that a crossfade leads to; 0 for none.
    [[nodiscard]] std::uint64_t version() const noexcept;

    static constexpr std::size_t blockSamples = 64;

private:
    [[nodiscard]] bool areSourcesIdle() const noexcept;
    void runProcessors(std::span<float> samplesMps2, EffectFigures& figures) noexcept;
    void passGate(std::span<float> samplesMps2) noexcept;
    void settleDelay() noexcept;
    [[nodiscard]] bool hasProcessors() const noexcept;

    effects::Impacts impact_;
    effects::Impacts edge_;
    effects::Relief relief_;
    effects::ClipSound clip_;
    effects::Signal signal_;
    dsp::Gate gate_;
    std::unique_ptr<Processors> processors_;
    std::unique_ptr<Processors> replaced_;
    // An exchange of processors keeps these two, because a new delay would lose the signal in the old one and a new
    // guard the measured exposure. A delay that is switched on or off is crossfaded as a member of its Processors; a
    // guard that is switched off measures on.
    std::unique_ptr<effects::Delay> delay_;
    std::unique_ptr<effects::ExposureGuard> guard_;
    std::size_t fadeSamples_;
    std::size_t fadeRemaining_ = 0;
};

/// The processors that a voice uses.
struct ProcessorSettings {
    /// Increases by 1 at each change; 0 if there was never a change.
    std::uint64_t version = 0;
    bool hasDelay = false;
    bool hasExposureGuard = false;
    /// Profile of the actuator to compensate; null for no compensation.
    std::shared_ptr<const effects::ActuatorProfile> actuator;
    /// Acceleration that is +-1 at the output of a voice that is made audible; 0 for a voice that is not.
    double listenFullScaleMps2 = 0.0;
};

/// Designs and allocates the processors, which takes milliseconds: not on the audio thread. Null for version 0. With
/// `keepsExposure` there is a guard even if the settings switch it off, for the exposure that it has measured. Throws
/// std::invalid_argument for a rate outside 8-192 kHz, std::bad_alloc.
[[nodiscard]] std::unique_ptr<Processors> makeProcessors(const ProcessorSettings& settings, double rateHz,
                                                         double delaySeconds, double actuatorGain, bool keepsExposure);

/// The parts of a voice that depend on the output rate. Construction allocates, so another thread than the callback's
/// makes one for each new rate.
struct OutputStage {
    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit OutputStage(double outputRateHz)
        : rateHz(outputRateHz),
          resampler(outputRateHz),
          gate(outputRateHz),
          effects(outputRateHz),
          strength(outputRateHz) {}

    double rateHz;
    dsp::WaveformResampler resampler;
    /// Gate of the texture only.
    dsp::Gate gate;
    EffectStage effects;
    dsp::LevelSmoother strength;
};

}  // namespace haptoflow::engine
