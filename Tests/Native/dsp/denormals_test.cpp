#include "dsp/denormals.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace haptoflow::dsp {
namespace {

// Volatile operands keep the compiler from evaluating the arithmetic at compile time.
float halfOfTheSmallestNormal() {
    volatile float smallest = std::numeric_limits<float>::min();
    volatile float half = 0.5F;
    return smallest * half;
}

float denormalTimesALot() {
    volatile float denormal = std::numeric_limits<float>::denorm_min();
    volatile float lot = 1e30F;
    return denormal * lot;
}

TEST(DenormalsTest, DenormalResultsAndOperandsAreFlushedOnlyWithinTheScope) {
    if (!ScopedFlushDenormals::isSupported) {
        GTEST_SKIP() << "this processor has no mode for it";
    }
    ASSERT_GT(halfOfTheSmallestNormal(), 0.0F);
    ASSERT_GT(denormalTimesALot(), 0.0F);
    {
        const ScopedFlushDenormals flush;
        EXPECT_EQ(halfOfTheSmallestNormal(), 0.0F);
        EXPECT_EQ(denormalTimesALot(), 0.0F);
        {
            const ScopedFlushDenormals nested;
            EXPECT_EQ(halfOfTheSmallestNormal(), 0.0F);
        }
        EXPECT_EQ(halfOfTheSmallestNormal(), 0.0F) << "leaving an inner scope ended the outer one";
    }
    EXPECT_GT(halfOfTheSmallestNormal(), 0.0F);
    EXPECT_GT(denormalTimesALot(), 0.0F);
}

}  // namespace
}  // namespace haptoflow::dsp
