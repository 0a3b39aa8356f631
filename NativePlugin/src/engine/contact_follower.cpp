#include "engine/contact_follower.hpp"

#include <cmath>
#include <cstddef>

namespace haptoflow::engine {

ContactAction ContactFollower::update(const ContactState& state, double nowSeconds) noexcept {
    const bool isTouching = state.touching != 0;
    // The counter starts at 0, so a first state with a counter above 0 reports a touch that began before that state.
    const bool newTouch = state.touchCounter != touchCounter_;
    const bool isNewContact = newTouch || (isTouching && !touching_);
    touches_ += isNewContact ? 1 : 0;
    touchCounter_ = state.touchCounter;
    touching_ = isTouching;
    const bool wasSliding = sliding_;
    const bool hasTexture = state.hasEffect(effects::EffectKind::texture);
    sliding_ = isTouching &&
               (state.hasPlace != 0 ? slidesByDistance(state, isNewContact, nowSeconds)
                                    : slidesBySpeed(state.speedMps(), newTouch)) &&
               hasTexture;
    if (sliding_) {
        return wasSliding && !newTouch ? ContactAction::slide : ContactAction::onset;
    }
    if (newTouch && hasTexture && !isTouching && state.speedMps() >= slideStartMps) {
        return ContactAction::tap;
    }
    return wasSliding ? ContactAction::release : ContactAction::rest;
}

bool ContactFollower::slidesBySpeed(float speedMps, bool isNewTouch) const noexcept {
    return speedMps >= (sliding_ && !isNewTouch ? slideEndMps : slideStartMps);
}

bool ContactFollower::slidesByDistance(const ContactState& state, bool isNewContact, double nowSeconds) noexcept {
    const float speed = state.speedMps();
    if (isNewContact || !pointMetres_ || surfaceSeed_ != state.surfaceSeed) {
        surfaceSeed_ = state.surfaceSeed;
        pointMetres_ = state.placeMetres;
        pulledSeconds_ = nowSeconds;
        return isNewContact ? speed >= strokeMps : sliding_;
    }
    std::array<float, 3> string{};
    for (std::size_t axis = 0; axis < string.size(); ++axis) {
        string[axis] = state.placeMetres[axis] - (*pointMetres_)[axis];
    }
    const float distance = std::hypot(string[0], string[1], string[2]);
    if (!sliding_ && distance < (speed >= strokeMps ? strokeStartMetres : startMetres)) {
        return false;
    }
    if (distance > stringMetres) {
        for (std::size_t axis = 0; axis < string.size(); ++axis) {
            (*pointMetres_)[axis] += string[axis] * (1.0F - stringMetres / distance);
        }
        pulledSeconds_ = nowSeconds;
    }
    if (speed >= stopMps && nowSeconds - pulledSeconds_ <= holdSeconds) {
        return true;
    }
    pointMetres_ = state.placeMetres;
    return false;
}

}  // namespace haptoflow::engine
