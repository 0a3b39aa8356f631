#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace haptoflow::engine {

/// Hands the newest message from one thread to another: a triple buffer. Both sides are wait-free, neither ever sees a
/// half-written message, and a message that nobody fetched is overwritten by the next.
/// One thread writes, one thread reads; the message type must not allocate when assigned.
template <typename Message>
class Mailbox {
public:
    Mailbox() = default;
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;
    ~Mailbox() = default;

    /// Writer: the message to fill. It holds what was written some posts ago: fill all of it.
    [[nodiscard]] Message& draft() noexcept { return slots_[writing_]; }
    /// Writer: makes the draft the newest message.
    void post() noexcept {
        const auto offered = static_cast<std::uint8_t>(writing_ | freshBit);
        writing_ = static_cast<std::uint8_t>(exchanged_.exchange(offered, std::memory_order_acq_rel) & indexBits);
    }

    /// Reader: takes the newest message where there is one that was not fetched yet; says whether there was.
    bool fetch() noexcept {
        if ((exchanged_.load(std::memory_order_relaxed) & freshBit) == 0) {
            return false;
        }
        reading_ = static_cast<std::uint8_t>(exchanged_.exchange(reading_, std::memory_order_acq_rel) & indexBits);
        return true;
    }
    /// Reader: the message fetched last; a default one before the first.
    [[nodiscard]] const Message& current() const noexcept { return slots_[reading_]; }

private:
    static constexpr std::uint8_t indexBits = 3;
    static constexpr std::uint8_t freshBit = 4;

    std::array<Message, 3> slots_{};
    std::uint8_t writing_ = 0;
    std::uint8_t reading_ = 1;
    std::atomic<std::uint8_t> exchanged_{2};
};

}  // namespace haptoflow::engine
