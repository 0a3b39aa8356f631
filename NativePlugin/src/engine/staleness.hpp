#pragma once

#include <algorithm>
#include <array>

namespace haptoflow::engine {

/// How long a contact state is good for: a tenth of a second, or longer where states come so seldom by design (10
/// frames a second, physics steps of 0.2 s). The period is the shorter of the last two, so that one long frame changes
/// nothing. A small value of the callback; allocates nothing.
class Staleness {
public:
    static constexpr double minimumSeconds = 0.1;
    static constexpr double maximumSeconds = 0.6;

    /// A state came, with others since the last block or alone, so long after the one before.
    void noteState(double secondsSinceLast) noexcept { gaps_ = {secondsSinceLast, gaps_[0]}; }

    /// Time without a contact state after which the contact is stale.
    [[nodiscard]] double seconds() const noexcept {
        return std::clamp(periods * std::min(gaps_[0], gaps_[1]), minimumSeconds, maximumSeconds);
    }

private:
    // One state may be missing, and the next late by half a period.
    static constexpr double periods = 2.5;

    std::array<double, 2> gaps_{};
};

}  // namespace haptoflow::engine
