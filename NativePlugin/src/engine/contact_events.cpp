#include "engine/contact_events.hpp"

#include "engine/tap_pieces.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {
namespace {

using effects::EffectKind;

// A full edge is a contact event at this share of the speed along the surface. An edge is full if its height reaches
// the width of a stylus tip, or if the level changes by 20 dB, as from a smooth to a rough material; smaller edges are
// in proportion.
constexpr double edgeShareOfSpeed = 0.2;
constexpr double fullEdgeMetres = 0.002;
constexpr double fullEdgeDb = 20.0;

}  // namespace

void ContactEvents::follow(const PublishedContact& contact, const Ingredients& materials,
                           const Ingredients& before) noexcept {
    events_.removeUpTo(channels_.takenEvent.load(std::memory_order_acquire));
    const ContactState& state = contact.state;
    const bool isNewTouch = contact.touch != last_.touch;
    if (isNewTouch) {
        newestSpeedsMps_.fill(0.0);
    }
    if (state.touching != 0) {
        std::ranges::rotate(newestSpeedsMps_, newestSpeedsMps_.begin() + 1);
        newestSpeedsMps_.back() = state.speedMps();
    }
    if (isNewTouch) {
        // An unchanged counter means that a surface without a label interrupted the touch, which has landed before. A
        // counter of 0 is that of a caller who does not count, or of the first touch of one who counts from 0.
        if (state.touchCounter != last_.state.touchCounter || state.touchCounter == 0) {
            addImpact(contact, materials);
        }
    } else if (last_.state.touching != 0) {
        noteTransition(contact, materials, before);
    }
    last_ = contact;
    if (state.touching != 0) {
        touched_ = state;
        touchedLabel_ = materials.heaviest().index;
    }
}

void ContactEvents::noteTransition(const PublishedContact& contact, const Ingredients& materials,
                                   const Ingredients& before) noexcept {
    const ContactState& state = contact.state;
    if (state.touching == 0) {
        // The tip has slid off the last surface: that surface's edge sounds by the tip's last speed.
        addEdge(contact, touched_, before, heightShare(state));
    } else if (state.landingCounter != last_.state.landingCounter) {
        addImpact(contact, materials);
    } else {
        addEdge(contact, state, materials, std::max(heightShare(state), levelShare(contact, materials, before)));
    }
}

void ContactEvents::addImpact(const PublishedContact& contact, const Ingredients& materials) noexcept {
    const ContactState& state = contact.state;
    if (state.hasEffect(EffectKind::impact) && state.approachSpeedMps > 0.0F) {
        add(contact, EffectKind::impact, state.approachSpeedMps, materials);
    }
}

void ContactEvents::addEdge(const PublishedContact& contact, const ContactState& state, const Ingredients& materials,
                            double share) noexcept {
    const double eventMps = edgeShareOfSpeed * std::ranges::max(newestSpeedsMps_) * std::min(share, 1.0);
    if (state.hasEffect(EffectKind::edge) && eventMps > 0.0) {
        add(contact, EffectKind::edge, static_cast<float>(eventMps), materials);
    }
}

void ContactEvents::add(const PublishedContact& contact, EffectKind kind, float speedMps,
                        const Ingredients& materials) noexcept {
    const ContactEvent event{.number = ++count_,
                             .update = contact.updates,
                             .touch = contact.touch,
                             .publishedSeconds = channels_.clock(),
                             .kind = kind,
                             .speedMps = speedMps,
                             .response = impactResponse(materials)};
    if (!events_.add(event)) {
        channels_.counters.lostEvents.fetch_add(1, std::memory_order_relaxed);
    }
}

double ContactEvents::heightShare(const ContactState& state) const noexcept {
    const bool isNew = state.edgeCounter != last_.state.edgeCounter;
    return isNew ? static_cast<double>(state.edgeHeightMetres) / fullEdgeMetres : 0.0;
}

double ContactEvents::levelShare(const PublishedContact& contact, const Ingredients& materials,
                                 const Ingredients& before) const noexcept {
    if (materials.heaviest().index == touchedLabel_) {
        return 0.0;
    }
    const auto& motion = contact.ranged.levelMotion;
    const auto beforeMps2 = static_cast<double>(before.levelMps2(motion));
    const auto afterMps2 = static_cast<double>(materials.levelMps2(motion));
    return std::abs(20.0 * std::log10(std::max(afterMps2, 1e-6) / std::max(beforeMps2, 1e-6))) / fullEdgeDb;
}

}  // namespace haptoflow::engine
