#include "web_imports.hpp"

#include <pthread.h>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

// Page, worker and audio thread each instantiate the module in one memory. The first instance runs the constructors; it
// makes a thread's block for each of the others, whose scripts enter it before they call anything (module.mjs).
namespace {

/// Larger than the C library's description of a thread in every version.
constexpr std::size_t threadBytes = 512;
constexpr std::size_t stackAlignment = 16;

}  // namespace

/// Returns a block: the description of a thread, its stack above. Zero if memory is out.
HAPTO_EXPORT HAPTO_NAMED("hapto_thread_create") void* hapto_thread_create(std::uint32_t stackBytes) {
    auto* block = static_cast<std::byte*>(std::aligned_alloc(stackAlignment, threadBytes + stackBytes));
    if (block == nullptr) {
        return nullptr;
    }
    std::memset(block, 0, threadBytes);
    // The main thread's locale and table of thread-specific values serve all. The first field points to the block.
    constexpr std::size_t copiedBytes = 128;
    // NOLINTNEXTLINE(bugprone-undefined-memory-manipulation)
    std::memcpy(block, reinterpret_cast<const void*>(pthread_self()), copiedBytes);
    const auto self = reinterpret_cast<std::uintptr_t>(block);
    std::memcpy(block, &self, sizeof(self));
    return block;
}
