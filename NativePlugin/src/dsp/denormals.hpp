#pragma once

#if defined(__SSE2__) || defined(_M_X64)
#include <immintrin.h>
#elif defined(__aarch64__) && defined(__GNUC__)
#include <cstdint>
#endif

namespace haptoflow::dsp {

/// Flushes denormal floats to zero on the calling thread until destruction, then restores the previous mode. Applies to
/// results and operands on x86 (MXCSR FTZ and DAZ) and 64-bit ARM (FPCR FZ); does nothing on other processors.
class [[nodiscard]] ScopedFlushDenormals {
public:
#if defined(__SSE2__) || defined(_M_X64)
    static constexpr bool isSupported = true;
    ScopedFlushDenormals() noexcept : saved_(_mm_getcsr()) {
        _mm_setcsr(saved_ | flushToZero | denormalsAreZero);
    }
    ~ScopedFlushDenormals() {
        _mm_setcsr(saved_);
    }
#elif defined(__aarch64__) && defined(__GNUC__)
    static constexpr bool isSupported = true;
    ScopedFlushDenormals() noexcept {
        __asm__ __volatile__("mrs %0, fpcr" : "=r"(saved_));
        const std::uint64_t flushing = saved_ | flushToZero;
        __asm__ __volatile__("msr fpcr, %0" : : "r"(flushing));
    }
    ~ScopedFlushDenormals() {
        __asm__ __volatile__("msr fpcr, %0" : : "r"(saved_));
    }
#else
    static constexpr bool isSupported = false;
    // Not defaulted, so that no compiler takes the object for an unused variable.
    ScopedFlushDenormals() noexcept {}
    ~ScopedFlushDenormals() {}
#endif
    ScopedFlushDenormals(const ScopedFlushDenormals&) = delete;
    ScopedFlushDenormals& operator=(const ScopedFlushDenormals&) = delete;

private:
#if defined(__SSE2__) || defined(_M_X64)
    static constexpr unsigned int flushToZero = 0x8000U;
    static constexpr unsigned int denormalsAreZero = 0x0040U;
    unsigned int saved_;
#elif defined(__aarch64__) && defined(__GNUC__)
    static constexpr std::uint64_t flushToZero = std::uint64_t{1} << 24;
    std::uint64_t saved_ = 0;
#endif
};

}  // namespace haptoflow::dsp
