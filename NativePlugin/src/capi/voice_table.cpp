#include "capi/voice_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace haptoflow::capi {
namespace {

constexpr haptoflow_voice placeBits = 0xFF;
constexpr int generationShift = 8;

// Constructed when the library is loaded, because the first user may be an audio thread, and never destroyed, because
// an audio thread may also be the last.
union Lasting {
    Lasting() : table() {}
    Lasting(const Lasting&) = delete;
    Lasting& operator=(const Lasting&) = delete;
    ~Lasting() {}
    VoiceTable table;
};
Lasting lasting;

}  // namespace

VoiceTable& voices() noexcept {
    return lasting.table;
}

haptoflow_voice VoiceTable::open(std::unique_ptr<OpenVoice> voice) {
    const std::lock_guard lock(mutex_);
    for (std::size_t index = 0; index < capacity; ++index) {
        Place& place = places_[index];
        if (place.voice != nullptr) {
            continue;
        }
        ++place.generation;
        const haptoflow_voice handle = (place.generation << generationShift) | index;
        place.voice = std::move(voice);
        place.handle.store(handle);
        return handle;
    }
    throw std::invalid_argument("all " + std::to_string(capacity) + " voices are in use: destroy one first");
}

bool VoiceTable::close(haptoflow_voice handle) {
    const std::lock_guard lock(mutex_);
    const std::size_t index = handle & placeBits;
    if (handle == 0 || index >= capacity || places_[index].handle.load() != handle) {
        return false;
    }
    Place* place = &places_[index];
    fadeOut({&place, 1});
    remove(*place);
    return true;
}

void VoiceTable::closeAll(const engine::LiveEngine& engine) {
    const std::lock_guard lock(mutex_);
    std::vector<Place*> closing;
    for (Place& place : places_) {
        if (place.voice != nullptr && place.voice->engine.get() == &engine) {
            closing.push_back(&place);
        }
    }
    fadeOut(closing);
    std::ranges::for_each(closing, [](Place* place) { remove(*place); });
}

void VoiceTable::fadeOut(std::span<Place* const> places) {
    const auto channels = [](const Place* place) -> engine::VoiceChannels& { return place->voice->voice->channels; };
    std::ranges::for_each(places, [&](Place* place) { channels(place).controls.closing.store(true); });
    const auto deadline = std::chrono::steady_clock::now() + fadeLimit;
    const auto isAudible = [&](const Place* place) { return channels(place).audible.load(std::memory_order_acquire); };
    while (std::ranges::any_of(places, isAudible) && std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void VoiceTable::remove(Place& place) {
    // From here on no new user gets the voice; present users are waited for. Both operations are sequentially
    // consistent, so that either this thread sees the user or the user sees that the handle is gone.
    place.handle.store(0);
    while (place.users.load() != 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    place.voice->engine->removeVoice(*place.voice->voice);
    place.voice.reset();
}

VoiceTable::Use VoiceTable::use(haptoflow_voice handle) noexcept {
    const std::size_t index = handle & placeBits;
    if (handle == 0 || index >= capacity) {
        return {};
    }
    Place& place = places_[index];
    place.users.fetch_add(1);
    if (place.handle.load() != handle) {
        place.users.fetch_sub(1, std::memory_order_release);
        return {};
    }
    return {&place.users, place.voice.get()};
}

VoiceTable::Use VoiceTable::useAt(std::size_t place) noexcept {
    return place < capacity ? use(places_[place].handle.load()) : Use{};
}

std::size_t VoiceTable::placeOf(haptoflow_voice handle) const noexcept {
    const std::size_t index = handle & placeBits;
    return handle != 0 && index < capacity && places_[index].handle.load() == handle ? index : capacity;
}

}  // namespace haptoflow::capi
