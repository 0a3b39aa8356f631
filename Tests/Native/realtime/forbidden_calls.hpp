#pragma once

#include <cstdint>

namespace haptoflow::realtime {

/// How often the calling thread allocated, freed, locked, waited or woke while it was watched. The C library's
/// functions are interposed by this program's own, which count and pass on.
class WatchedSection {
public:
    WatchedSection() noexcept;
    WatchedSection(const WatchedSection&) = delete;
    WatchedSection& operator=(const WatchedSection&) = delete;
    ~WatchedSection();
};

/// Of all watched sections of all threads so far.
[[nodiscard]] std::uint64_t forbiddenCalls() noexcept;
/// Name of the function that was called last in a watched section; "" for none.
[[nodiscard]] const char* lastForbiddenCall() noexcept;

}  // namespace haptoflow::realtime
