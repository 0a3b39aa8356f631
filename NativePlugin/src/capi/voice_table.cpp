#include "capi/voice_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

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

bool VoiceTable::Use::isClosed() const noexcept {
    return get()->voice->channels.controls.closing.load();
}

void VoiceTable::Use::endOnceSilent() const noexcept {
    if (isClosed() && !get()->voice->channels.audible.load(std::memory_order_relaxed)) {
        place_->handle.store(0);
    }
}

haptoflow_voice VoiceTable::open(std::unique_ptr<OpenVoice> voice) {
    Ended ended;
    const std::lock_guard lock(mutex_);
    collect(ended);
    if (freePlace() == nullptr) {
        collect(ended, true);
    }
    Place* place = freePlace();
    if (place == nullptr) {
        throw std::invalid_argument("all " + std::to_string(capacity) + " voices are in use: destroy one first");
    }
    ++place->generation;
    const auto index = static_cast<haptoflow_voice>(place - places_.data());
    const haptoflow_voice handle = (place->generation << generationShift) | index;
    place->voice = std::move(voice);
    place->handle.store(handle);
    return handle;
}

bool VoiceTable::close(haptoflow_voice handle) {
    Ended ended;
    const std::lock_guard lock(mutex_);
    const std::size_t index = placeOf(handle);
    if (index == capacity) {
        return false;
    }
    beginToClose(places_[index]);
    collect(ended);
    return true;
}

void VoiceTable::closeAll(const engine::LiveEngine& engine) {
    Ended ended;
    const std::lock_guard lock(mutex_);
    for (Place& place : places_) {
        if (place.voice != nullptr && place.voice->engine.get() == &engine) {
            beginToClose(place);
        }
    }
    collect(ended);
}

VoiceTable::Place* VoiceTable::freePlace() noexcept {
    const auto found = std::ranges::find_if(places_, [](const Place& place) { return place.voice == nullptr; });
    return found == places_.end() ? nullptr : &*found;
}

void VoiceTable::beginToClose(Place& place) noexcept {
    OpenVoice& closing = *place.voice;
    if (!closing.voice->channels.controls.closing.exchange(true)) {
        closing.engine->removeVoice(*closing.voice);
        place.closedAt = std::chrono::steady_clock::now();
    }
}

void VoiceTable::collect(Ended& ended, bool endsFades) {
    const auto now = std::chrono::steady_clock::now();
    for (Place& place : places_) {
        if (place.voice == nullptr || !place.voice->voice->channels.controls.closing.load()) {
            continue;
        }
        // A block that began before the voice was closed may still make it audible; a later one cannot.
        const bool isSilent = place.users.load() == 0 && !place.voice->voice->channels.audible.load();
        if (isSilent || endsFades || now - place.closedAt > fadeLimit) {
            place.handle.store(0);
        }
        // All operations are sequentially consistent, so that either this thread sees a user or the user sees that the
        // handle is gone.
        if (place.handle.load() == 0 && place.users.load() == 0) {
            ended.push_back(std::move(place.voice));
        }
    }
}

VoiceTable::Use VoiceTable::useToRender(haptoflow_voice handle) noexcept {
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
    return Use(&place);
}

VoiceTable::Use VoiceTable::use(haptoflow_voice handle) noexcept {
    Use found = useToRender(handle);
    return found && !found.isClosed() ? std::move(found) : Use{};
}

VoiceTable::Use VoiceTable::useAt(std::size_t place) noexcept {
    return place < capacity ? useToRender(places_[place].handle.load()) : Use{};
}

std::size_t VoiceTable::placeOf(haptoflow_voice handle) noexcept {
    return use(handle) ? static_cast<std::size_t>(handle & placeBits) : capacity;
}

}  // namespace haptoflow::capi
