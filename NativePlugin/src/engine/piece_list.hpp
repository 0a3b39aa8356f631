#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// What holds from one sample in waveform time to the next: one piece for each segment, in the order of their starts.
/// `Piece` has a member `start`. Allocates nothing; used by one thread.
template <typename Piece>
class PieceList {
public:
    /// Begins a stream with this piece alone.
    void begin(const Piece& piece) noexcept {
        pieces_[0] = piece;
        count_ = 1;
    }
    /// Adds a piece and removes those that start where it does or later. When full, drops the oldest.
    void add(const Piece& piece) noexcept {
        while (count_ > 0 && pieces_[count_ - 1].start >= piece.start) {
            --count_;
        }
        if (count_ == capacity) {
            std::ranges::copy(pieces_.begin() + 1, pieces_.end(), pieces_.begin());
            --count_;
        }
        pieces_[count_] = piece;
        ++count_;
    }
    /// The newest piece that starts at or before a sample, or else the oldest.
    [[nodiscard]] const Piece& at(std::int64_t sample) const noexcept {
        std::size_t newest = count_ - 1;
        while (newest > 0 && pieces_[newest].start > sample) {
            --newest;
        }
        return pieces_[newest];
    }

private:
    // Only pieces ahead of the read head can be removed. A timeline reaches 600 samples ahead and a hop takes at least
    // 10, so none that is still needed is dropped.
    static constexpr std::size_t capacity = 64;

    std::array<Piece, capacity> pieces_{};
    std::size_t count_ = 1;
};

}  // namespace haptoflow::engine
