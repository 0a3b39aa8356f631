#include "capi/handles.hpp"
#include "inference/tiny_model.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace haptoflow::capi {
namespace {

TEST(TierLoaderTest, TheTiersOfOneEngineShareTheSessionsOfEqualGraphs) {
    const auto open =
        std::make_shared<const OpenModel>(model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow"));
    const TierLoader loader{.runtime = inference::testing::testRuntime(), .model = open, .batch = 4};
    std::vector<std::unique_ptr<inference::SegmentGenerator>> tiers;
    for (std::size_t tier = 0; tier < open->model.header().tiers.size(); ++tier) {
        tiers.push_back(loader.load(tier, {}));
    }
    EXPECT_EQ(tiers.size(), 5U);
    // `standard` and `fine` have one field; `latent` has an encoder and a decoder too.
    EXPECT_EQ(loader.sessions->loaded(), 6U);
}

}  // namespace
}  // namespace haptoflow::capi
