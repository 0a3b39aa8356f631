#include "engine/contact_follower.hpp"

#include <cmath>

namespace haptoflow::engine {

ContactAction ContactFollower::update(const ContactState& state) noexcept {
    const float speed = std::hypot(state.velocityMps[0], state.velocityMps[1]);
    // A voice begins at touch 0: a counter beyond it in its very first state tells of a tap before that state.
    const bool newTouch = state.touchCounter != touchCounter_;
    touches_ += newTouch || (state.touching && !touching_) ? 1 : 0;
    touchCounter_ = state.touchCounter;
    touching_ = state.touching;
    const bool wasSliding = sliding_;
    const float threshold = wasSliding && !newTouch ? slideEndMps : slideStartMps;
    const bool hasTexture = state.asksFor(effects::EffectKind::texture);
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
