#include "engine/seed_retrieval.hpp"

#include <cmath>
#include <limits>

namespace haptoflow::engine {
namespace {

// Added to speed and force before taking logarithms, because smaller differences cannot be felt.
constexpr double restMps = 0.002;
constexpr double restNewtons = 0.05;
constexpr double forceShare = 0.5;
constexpr double directionShare = 0.1;

double distance(const Seed& seed, const std::array<float, 3>& motion) {
    const double speed = std::hypot(motion[0], motion[1]);
    const double seedSpeed = std::hypot(seed.velocityMps[0], seed.velocityMps[1]);
    const double speedGap = std::log((speed + restMps) / (seedSpeed + restMps));
    const double forceGap = std::log((motion[2] + restNewtons) / (seed.forceNewtons + restNewtons));
    const double along =
        (seed.velocityMps[0] * motion[0] + seed.velocityMps[1] * motion[1]) / (speed * seedSpeed + restMps * restMps);
    return speedGap * speedGap + forceShare * forceGap * forceGap + directionShare * (1.0 - along * along);
}

}  // namespace

const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept {
    double nearest = std::numeric_limits<double>::infinity();
    const Seed* chosen = nullptr;
    for (const Seed& seed : seeds) {
        const double gap = distance(seed, motion);
        if (gap < nearest) {
            nearest = gap;
            chosen = &seed;
        }
    }
    return chosen;
}

}  // namespace haptoflow::engine
