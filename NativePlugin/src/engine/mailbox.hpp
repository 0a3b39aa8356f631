#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace haptoflow::engine {

/// Passes the newest message from one writing to one reading thread through a triple buffer. Both sides are wait-free,
/// a message is never read half-written, and a message that was not fetched is replaced by the next. The message type
/// must not allocate when assigned.
template <typename Message>
class Mailbox {
public:
    Mailbox() = default;
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;
    ~Mailbox() = default;

    /// Writer: the message to fill. It contains an old message, so every field must be written.
    [[nodiscard]] Message& draft() noexcept { return slots_[writing_]; }
    /// Writer: publishes the draft as the newest message.
    void post() noexcept {
        const auto offered = static_cast<std::uint8_t>(writing_ | freshBit);
        writing_ = static_cast<std::uint8_t>(exchanged_.exchange(offered, std::memory_order_acq_rel) & indexBits);
    }

    /// Reader: fetches the newest message. Returns false if there is none since the last fetch.
    bool fetch() noexcept {
        if ((exchanged_.load(std::memory_order_relaxed) & freshBit) == 0) {
            return false;
        }
        reading_ = static_cast<std::uint8_t>(exchanged_.exchange(reading_, std::memory_order_acq_rel) & indexBits);
        return true;
    }
    /// Reader: the message fetched last; default-constructed before the first fetch.
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
