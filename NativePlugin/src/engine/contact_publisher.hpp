#pragma once

#include "engine/contact_follower.hpp"
#include "engine/contact_state.hpp"
#include "engine/onset_levels.hpp"
#include "engine/voice_channels.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstdint>

namespace haptoflow::engine {

/// The main thread's end of a voice: turns contact states into messages to callback and worker. Wait-free, allocates
/// nothing; one thread at a time. Model and levels must outlive it.
class ContactPublisher {
public:
    ContactPublisher(const model::ModelFile& model, const OnsetLevels& levels, VoiceChannels& channels) noexcept;

    /// Returns what the state means for the voice. The state is sanitised first, and what had to be changed counted.
    ContactAction publish(ContactState state) noexcept;

private:
    void noteImpact(const ContactState& state) noexcept;
    void noteTransition(const ContactState& state, std::size_t dominantLabel,
                        const std::array<float, 3>& motion) noexcept;
    void noteSpeed(const ContactState& state, bool isNewTouch) noexcept;
    /// Of the surface of `state`, with the largest of the newest speeds.
    void strikeEdge(const ContactState& state, double share) noexcept;
    void remember(const ContactState& state, std::size_t dominantLabel) noexcept;
    /// How much of a full edge the newest one is, by its height or by the change of level from the label before; may be
    /// above 1.
    [[nodiscard]] double heightShare(const ContactState& state) const noexcept;
    [[nodiscard]] double levelShare(const ContactState& state, std::size_t dominantLabel,
                                    const std::array<float, 3>& motion) const noexcept;
    void retrieve(const ContactState& state, std::size_t label, const std::array<float, 3>& motion) noexcept;

    const model::ModelFile& model_;
    const OnsetLevels& levels_;
    VoiceChannels& channels_;
    ContactFollower follower_;
    std::uint32_t onsets_ = 0;
    std::uint64_t slides_ = 0;
    std::array<float, WaveformTimeline::seedSamples> seedMps2_{};
    SeedRibs seedRibs_{};
    BlowMessage impact_;
    BlowMessage edge_;
    bool wasTouching_ = false;
    std::uint32_t lastTouchCounter_ = 0;
    std::uint32_t lastEdgeCounter_ = 0;
    std::uint32_t lastLandingCounter_ = 0;
    // The speeds of this touch's newest states. Where the tip rounds a rim, the surface's normal points along the
    // motion for a few states, and the speed along the surface is near 0.
    std::array<double, 4> newestSpeedsMps_{};
    // The last state that touched.
    ContactState last_;
    std::size_t lastLabel_ = 0;
};

}  // namespace haptoflow::engine
