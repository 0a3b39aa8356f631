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

/// The part of a voice that runs on the main thread: converts contact states to messages for the callback and the
/// worker. Wait-free, allocates nothing; used by one thread at a time. The library must outlive it.
class ContactPublisher {
public:
    /// Minimum speed at which a signal sounds.
    static constexpr float signalSpeedMps = 0.005F;

    ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels);

    /// Publishes a state and returns the voice's action. The state is sanitised first; changed fields are counted.
    ContactAction publish(ContactState state) noexcept;

private:
    /// A state with its materials and those of the last touching state.
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
    /// Strikes an edge of the surface of `state` at the largest of the newest speeds. `share` is the share of a full
    /// edge.
    void strikeEdge(const ContactState& state, const Ingredients& ingredients, double share) noexcept;
    void addBlow(effects::EffectKind kind, float speedMps, const Ingredients& ingredients) noexcept;
    void remember(const Contact& contact) noexcept;
    /// The newest edge as a share of a full edge, by its height or by the change of level from the last label; may
    /// exceed 1.
    [[nodiscard]] double heightShare(const ContactState& state) const noexcept;
    [[nodiscard]] double levelShare(const Contact& contact) const noexcept;
    void retrieve(const Contact& contact, const Material& material) noexcept;
    void postToAudio(const Contact& contact) noexcept;
    void postToWorker(const Contact& contact, const Material& material) noexcept;

    const MaterialLibrary& library_;
    VoiceChannels& channels_;
    const dsp::ToneCepstrum tiltPerDecibel_ = designTilt();
    ContactFollower follower_;
    std::uint32_t onsets_ = 0;
    std::uint64_t slides_ = 0;
    std::array<float, WaveformTimeline::seedSamples> seedMps2_{};
    SeedRibs seedRibs_{};
    BlowList blows_;
    std::uint64_t blowCount_ = 0;
    std::uint64_t updates_ = 0;
    bool isMoving_ = false;
    double movingSinceSeconds_ = 0.0;
    bool wasTouching_ = false;
    std::uint32_t lastTouchCounter_ = 0;
    std::uint32_t lastEdgeCounter_ = 0;
    std::uint32_t lastLandingCounter_ = 0;
    // Speeds of the newest states of this touch. The largest is used for edges: on a rounded rim, the surface normal
    // points along the motion for a few states, so that the speed along the surface is near 0.
    std::array<double, 4> newestSpeedsMps_{};
    // The last touching state.
    ContactState last_;
    std::uint32_t lastLabel_ = 0;
    // Wave vectors of the newest touching state.
    WaveVectors ribs_{};
};

}  // namespace haptoflow::engine
