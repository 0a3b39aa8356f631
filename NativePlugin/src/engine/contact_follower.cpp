#include "engine/contact_follower.hpp"

namespace haptoflow::engine {

ContactAction ContactFollower::update(const ContactState& state) noexcept {
    const float speed = state.speedMps();
    const bool isTouching = state.touching != 0;
    // The counter starts at 0, so a first state with a counter above 0 reports a touch that began before that state.
    const bool newTouch = state.touchCounter != touchCounter_;
    touches_ += newTouch || (isTouching && !touching_) ? 1 : 0;
    touchCounter_ = state.touchCounter;
    touching_ = isTouching;
    const bool wasSliding = sliding_;
    const float threshold = wasSliding && !newTouch ? slideEndMps : slideStartMps;
    const bool hasTexture = state.hasEffect(effects::EffectKind::texture);
    sliding_ = hasTexture && isTouching && speed >= threshold;
    if (sliding_) {
        return wasSliding && !newTouch ? ContactAction::slide : ContactAction::onset;
    }
    if (newTouch && hasTexture && !isTouching && speed >= slideStartMps) {
        return ContactAction::tap;
    }
    return wasSliding ? ContactAction::release : ContactAction::rest;
}

}  // namespace haptoflow::engine
