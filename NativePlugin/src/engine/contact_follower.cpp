#include "engine/contact_follower.hpp"

#include <cmath>

namespace haptoflow::engine {

ContactAction ContactFollower::update(const ContactState& state) noexcept {
    const float speed = std::hypot(state.velocityMps[0], state.velocityMps[1]);
    // Touches before the first state were somebody else's.
    const bool newTouch = begun_ && state.touchCounter != touchCounter_;
    begun_ = true;
    touchCounter_ = state.touchCounter;
    const bool wasSliding = sliding_;
    const float threshold = wasSliding && !newTouch ? slideEndMps : slideStartMps;
    sliding_ = state.touching && speed >= threshold;
    if (sliding_) {
        return wasSliding && !newTouch ? ContactAction::slide : ContactAction::onset;
    }
    if (newTouch && !state.touching && speed >= slideStartMps) {
        return ContactAction::tap;
    }
    return wasSliding ? ContactAction::release : ContactAction::rest;
}

}  // namespace haptoflow::engine
