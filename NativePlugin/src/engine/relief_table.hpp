#pragma once

#include "effects/relief_map.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace haptoflow::engine {

/// The reliefs of the process by their numbers, which are never 0 and never used again. Thread-safe.
class ReliefTable {
public:
    /// Throws std::bad_alloc.
    [[nodiscard]] std::uint32_t add(std::shared_ptr<const effects::ReliefMap> map);
    /// Voices that play it go on until their next contact state. Returns false for a number that is not in use.
    bool remove(std::uint32_t number);

    /// Brings what a publisher keeps (a number, the table's edition when it was looked up, and the map) to `wanted`; an
    /// unknown number has no map. Waits for nothing: while another thread changes the table, it changes nothing.
    void follow(std::uint32_t wanted, std::uint32_t& number, std::uint64_t& edition,
                std::shared_ptr<const effects::ReliefMap>& map) const noexcept;

private:
    mutable std::mutex mutex_;
    std::unordered_map<std::uint32_t, std::shared_ptr<const effects::ReliefMap>> maps_;
    std::uint32_t last_ = 0;
    std::atomic<std::uint64_t> edition_{0};
};

[[nodiscard]] ReliefTable& reliefs() noexcept;

}  // namespace haptoflow::engine
