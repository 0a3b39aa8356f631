#pragma once

#include "engine/contact_state.hpp"

#include <cstdint>

namespace haptoflow::engine {

/// The voice's response to a published contact state.
enum class ContactAction {
    /// The tip does not slide: no texture.
    rest,
    /// A touch begins, or sliding resumes: a seed starts.
    onset,
    /// A touch began and ended since the last state: a seed sounds briefly.
    tap,
    /// Sliding continues: the next segment is generated.
    slide,
    /// Contact or sliding ended: the texture is silent within 5 ms.
    release,
};

/// Derives actions from the contact states of one stylus. Texture sounds only while the tip slides, and only on
/// surfaces with the texture effect.
class ContactFollower {
public:
    /// Sliding begins at 4 mm/s and ends below 2 mm/s.
    static constexpr float slideStartMps = 0.004F;
    static constexpr float slideEndMps = 0.002F;

    [[nodiscard]] ContactAction update(const ContactState& state) noexcept;
    [[nodiscard]] bool sliding() const noexcept { return sliding_; }
    /// Number of touch-downs so far, independent of the caller's touch counter.
    [[nodiscard]] std::uint64_t touches() const noexcept { return touches_; }

private:
    std::uint32_t touchCounter_ = 0;
    std::uint64_t touches_ = 0;
    bool touching_ = false;
    bool sliding_ = false;
};

}  // namespace haptoflow::engine
