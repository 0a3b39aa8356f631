#pragma once

#include "engine/contact_follower.hpp"
#include "engine/contact_state.hpp"
#include "engine/material.hpp"
#include "engine/material_library.hpp"
#include "engine/range_law.hpp"
#include "engine/voice_channels.hpp"

#include <array>
#include <cstdint>

namespace haptoflow::engine {

/// The main thread's end of a voice: turns contact states into messages to callback and worker. Wait-free, allocates
/// nothing; one thread at a time. The library must outlive it.
class ContactPublisher {
public:
    /// A signal sounds from this speed on.
    static constexpr float signalSpeedMps = 0.005F;

    ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels);

    /// Returns what the state means for the voice. The state is sanitised first, and what had to be changed counted.
    ContactAction publish(ContactState state) noexcept;

private:
    /// A state with what its materials, and those of the last state that touched, are.
    struct Contact {
        const ContactState& state;
        Ingredients ingredients;
        Ingredients before;
        RangedMotion ranged;
        bool hasSignal;
    };

    void noteMotion(const ContactState& state) noexcept;

    void noteImpact(const Contact& contact) noexcept;
    void noteTransition(const Contact& contact) noexcept;
    void noteSpeed(const ContactState& state, bool isNewTouch) noexcept;
    /// Of the surface of `state`, with the largest of the newest speeds.
    void strikeEdge(const ContactState& state, const Ingredients& ingredients, double share) noexcept;
    void remember(const Contact& contact) noexcept;
    /// How much of a full edge the newest one is, by its height or by the change of level from the label before; may be
    /// above 1.
    [[nodiscard]] double heightShare(const ContactState& state) const noexcept;
    [[nodiscard]] double levelShare(const Contact& contact) const noexcept;
    void retrieve(const Contact& contact, const Material& material) noexcept;
    void postToAudio(const Contact& contact) noexcept;
    void postToWorker(const Contact& contact, const Material& material) noexcept;

    const MaterialLibrary& library_;
    VoiceChannels& channels_;
    const dsp::ToneCepstrum tiltOfOne_ = designTilt();
    ContactFollower follower_;
    std::uint32_t onsets_ = 0;
    std::uint64_t slides_ = 0;
    std::array<float, WaveformTimeline::seedSamples> seedMps2_{};
    SeedRibs seedRibs_{};
    BlowMessage impact_;
    BlowMessage edge_;
    bool isMoving_ = false;
    double movingSinceSeconds_ = 0.0;
    bool wasTouching_ = false;
    std::uint32_t lastTouchCounter_ = 0;
    std::uint32_t lastEdgeCounter_ = 0;
    std::uint32_t lastLandingCounter_ = 0;
    // The speeds of this touch's newest states. Where the tip rounds a rim, the surface's normal points along the
    // motion for a few states, and the speed along the surface is near 0.
    std::array<double, 4> newestSpeedsMps_{};
    // The last state that touched.
    ContactState last_;
    std::uint32_t lastLabel_ = 0;
    // Of this touch's newest state.
    WaveVectors ribs_{};
};

}  // namespace haptoflow::engine
