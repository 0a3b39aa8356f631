#pragma once

#include "engine/contact_events.hpp"
#include "engine/contact_messages.hpp"
#include "engine/contact_state.hpp"
#include "engine/material.hpp"
#include "engine/material_library.hpp"
#include "engine/relief_table.hpp"
#include "engine/stream_parameters.hpp"
#include "engine/voice_channels.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace haptoflow::engine {

/// The voice's response to a published contact state.
enum class ContactAction {
    /// The tip does not slide: no texture.
    rest,
    /// A touch begins, or sliding resumes: a seed starts.
    onset,
    /// A touch began and ended since the last state: a seed sounds briefly.
    tap,
    /// Sliding continues: the next segment is generated.
    slide,
    /// Contact or sliding ended: the texture is silent within 5 ms.
    release,
};

/// Derives actions from the contact states of one stylus. Texture sounds only while the tip slides, and only on
/// surfaces with the texture effect.
///
/// Where the place is known, the distance decides and not the speed alone, so that a tip which creeps is heard and a
/// tip which a hand holds still is not, although its tremor of up to half a millimetre is faster than creeping. Sliding
/// begins a millimetre from where the tip came to rest, or 0.75 mm from there at the speed of a stroke, 40 mm/s. It
/// goes on while the tip draws a point along behind it on a slack string of half a millimetre (the play operator of
/// hysteresis: Visintin, "Differential Models of Hysteresis", 1994), and ends when the tip stops or has not moved that
/// point for 150 ms, in which a tip at 7 mm/s turns back.
///
/// Where the place is unknown, the speed decides: from 4 mm/s on, until below 2 mm/s.
class ContactFollower {
public:
    static constexpr float slideStartMps = 0.004F;
    static constexpr float slideEndMps = 0.002F;
    static constexpr float strokeMps = 0.04F;
    static constexpr float stopMps = 0.0003F;
    static constexpr float stringMetres = 0.0005F;
    static constexpr float startMetres = 0.001F;
    static constexpr float strokeStartMetres = 0.00075F;
    static constexpr double holdSeconds = 0.15;

    /// `nowSeconds` is the time of the state on a clock that runs while the voice is rendered.
    [[nodiscard]] ContactAction update(const ContactState& state, double nowSeconds) noexcept;
    [[nodiscard]] bool sliding() const noexcept { return sliding_; }
    /// Number of touch-downs so far, independent of the caller's touch counter.
    [[nodiscard]] std::uint64_t touches() const noexcept { return touches_; }

private:
    [[nodiscard]] bool slidesBySpeed(float speedMps, bool isNewTouch) const noexcept;
    [[nodiscard]] bool slidesByDistance(const ContactState& state, bool isNewContact, double nowSeconds) noexcept;

    std::uint32_t touchCounter_ = 0;
    std::uint64_t touches_ = 0;
    bool touching_ = false;
    bool sliding_ = false;
    // The end of the string: where the tip came to rest, or what it draws along. Empty before the first known place.
    std::optional<std::array<float, 3>> pointMetres_;
    std::uint32_t surfaceSeed_ = 0;
    double pulledSeconds_ = 0.0;
};

/// The part of a voice that runs on the main thread: converts contact states to messages for the callback and the
/// worker. Wait-free, allocates nothing; used by one thread at a time. The library must outlive it.
class ContactPublisher {
public:
    ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels, StreamParameterMaker streams);

    /// Publishes a state and returns the voice's action. The state is sanitised first; changed fields are counted.
    ContactAction publish(ContactState state) noexcept;

private:
    void followRelief(const Ingredients& ingredients) noexcept;
    void prepareStream(const Ingredients& ingredients, const Material& material) noexcept;
    void post(const std::optional<dsp::ToneCepstrum>& tone) noexcept;

    const MaterialLibrary& library_;
    VoiceChannels& channels_;
    StreamParameterMaker streams_;
    const dsp::ToneCepstrum tiltPerDecibel_ = designTilt();
    ContactFollower follower_;
    ContactEvents events_;
    // The newest contact, what follows from the newest sliding one, and the time since which the tip moves or rests.
    PublishedContact contact_;
    MaterialInputs material_;
    skeleton::StreamParameters stream_;
    double movingSinceSeconds_ = 0.0;
    // The map of `reliefNumber_`, so that the table is searched only for another.
    std::shared_ptr<const effects::ReliefMap> relief_;
    std::uint32_t reliefNumber_ = 0;
    std::uint64_t reliefEdition_ = 0;
    double reliefStiffness_ = 0.0;
    // Wave vectors of the newest touching state.
    WaveVectors ribs_{};
};

}  // namespace haptoflow::engine
