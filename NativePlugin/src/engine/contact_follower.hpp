#pragma once

#include "engine/contact_state.hpp"

#include <cstdint>

namespace haptoflow::engine {

/// What a voice has to do about a published contact state.
enum class ContactAction {
    /// Nothing touches, nothing sounds.
    rest,
    /// A touch begins, or sliding resumes: a seed sounds.
    onset,
    /// The tip slid over the surface and left it since the last state: a seed sounds and ends.
    tap,
    /// Sliding goes on: the next segment is wanted.
    slide,
    /// Contact or sliding ended: silence within 5 ms.
    release,
};

/// Follows one stylus's contact states. A tip that touches but does not slide is silent: texture comes from sliding,
/// and only on surfaces that ask for it.
class ContactFollower {
public:
    /// Sliding begins at 4 mm/s and ends below 2 mm/s.
    static constexpr float slideStartMps = 0.004F;
    static constexpr float slideEndMps = 0.002F;

    [[nodiscard]] ContactAction update(const ContactState& state) noexcept;
    [[nodiscard]] bool sliding() const noexcept { return sliding_; }
    /// Touch-downs so far, however the caller numbers its touches.
    [[nodiscard]] std::uint64_t touches() const noexcept { return touches_; }

private:
    std::uint32_t touchCounter_ = 0;
    std::uint64_t touches_ = 0;
    bool touching_ = false;
    bool sliding_ = false;
};

}  // namespace haptoflow::engine
