#pragma once

#include "engine/contact_blows.hpp"
#include "engine/contact_follower.hpp"
#include "engine/contact_messages.hpp"
#include "engine/contact_state.hpp"
#include "engine/material.hpp"
#include "engine/material_library.hpp"
#include "engine/voice_channels.hpp"
#include "skeleton/skeleton_tensors.hpp"

namespace haptoflow::engine {

/// The part of a voice that runs on the main thread: converts contact states to messages for the callback and the
/// worker. Wait-free, allocates nothing; used by one thread at a time. The library must outlive it.
class ContactPublisher {
public:
    /// `native` is empty for a model without a skeleton.
    ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels, skeleton::NativeParts native);

    /// Publishes a state and returns the voice's action. The state is sanitised first; changed fields are counted.
    ContactAction publish(ContactState state) noexcept;

private:
    void prepareSketch(const MaterialInputs& inputs) noexcept;
    void postToAudio(const Ingredients& ingredients, const MaterialInputs& inputs, bool hasSignal) noexcept;
    void postToWorker(const Ingredients& ingredients, const MaterialInputs& inputs) noexcept;

    const MaterialLibrary& library_;
    VoiceChannels& channels_;
    skeleton::NativeParts native_;
    const dsp::ToneCepstrum tiltPerDecibel_ = designTilt();
    ContactFollower follower_;
    ContactBlows blows_;
    // The newest contact, its seed or sketch, and the time since which it moves or rests.
    PublishedContact contact_;
    OnsetSeed seed_;
    PreparedSketch sketch_;
    double movingSinceSeconds_ = 0.0;
    // Wave vectors of the newest touching state.
    WaveVectors ribs_{};
};

}  // namespace haptoflow::engine
