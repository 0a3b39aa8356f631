#include "engine/contact_follower.hpp"

#include <cmath>

namespace haptoflow::engine {

ContactAction ContactFollower::update(const ContactState& state) noexcept {
    const float speed = std::hypot(state.velocityMps[0], state.velocityMps[1]);
    // The counter starts at 0, so a first state with a counter above 0 reports a touch that began before that state.
    const bool newTouch = state.touchCounter != touchCounter_;
    touches_ += newTouch || (state.touching && !touching_) ? 1 : 0;
    touchCounter_ = state.touchCounter;
    touching_ = state.touching;
    const bool wasSliding = sliding_;
    const float threshold = wasSliding && !newTouch ? slideEndMps : slideStartMps;
    const bool hasTexture = state.hasEffect(effects::EffectKind::texture);
    sliding_ = hasTexture && state.touching && speed >= threshold;
    if (sliding_) {
        return wasSliding && !newTouch ? ContactAction::slide : ContactAction::onset;
    }
    if (newTouch && hasTexture && !state.touching && speed >= slideStartMps) {
        return ContactAction::tap;
    }
    return wasSliding ? ContactAction::release : ContactAction::rest;
}

}  // namespace haptoflow::engine
