#include "exit_codes.hpp"
#include "model_location.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace haptoflow::cli {
namespace {

using ::testing::HasSubstr;

/// Sets or removes an environment variable for the duration of a test.
class Environment {
public:
    Environment(const char* name, const std::optional<std::string>& value) : name_(name) {
        if (const char* before = std::getenv(name)) {
            before_ = before;
        }
        apply(value);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    ~Environment() { apply(before_); }

private:
    void apply(const std::optional<std::string>& value) const {
        if (value) {
            setenv(name_, value->c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }

    const char* name_;
    std::optional<std::string> before_;
};

template <typename Action>
std::string refusalOf(Action action) {
    try {
        (void)action();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return {};
}

TEST(ModelLocationTest, AGivenModelIsUsedFirst) {
    const Environment model("HAPTOFLOW_MODEL", HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_EQ(findModel("mine.haptoflow"), "mine.haptoflow");
}

TEST(ModelLocationTest, TheEnvironmentNamesTheModel) {
    const Environment model("HAPTOFLOW_MODEL", HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_EQ(findModel(""), HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_EQ(readModel(findModel("")).header().name, "tiny");
}

TEST(ModelLocationTest, AMissingModelOfTheEnvironmentIsRefusedWithTheVariable) {
    const Environment model("HAPTOFLOW_MODEL", "/nowhere/a.haptoflow");
    const std::string refusal = refusalOf([] { return findModel(""); });
    EXPECT_THAT(refusal, HasSubstr("/nowhere/a.haptoflow"));
    EXPECT_THAT(refusal, HasSubstr("HAPTOFLOW_MODEL"));
}

TEST(ModelLocationTest, TheErrorForAMissingRuntimeNamesThePlacesAndTheRemedy) {
    // The test program is deeper in the build folder than the command line, so that none of the places exists.
    const Environment runtime("HAPTOFLOW_ONNXRUNTIME", std::nullopt);
    const std::string refusal = refusalOf([] { return findOnnxRuntime(); });
    EXPECT_THAT(refusal, HasSubstr("HAPTOFLOW_ONNXRUNTIME (not set)"));
    EXPECT_THAT(refusal, HasSubstr("node_modules/com.github.asus4.onnxruntime/Plugins"));
    EXPECT_THAT(refusal, HasSubstr("`npm ci`"));
    EXPECT_THAT(refusal, HasSubstr("`npm run build`"));
}

TEST(ModelLocationTest, TheRuntimeOfTheEnvironmentIsOpened) {
    const Environment runtime("HAPTOFLOW_ONNXRUNTIME", HAPTOFLOW_TEST_ONNXRUNTIME);
    EXPECT_FALSE(openRuntime()->version().empty());
}

TEST(ModelLocationTest, ARuntimeThatIsNotALibraryIsAnInputError) {
    const Environment runtime("HAPTOFLOW_ONNXRUNTIME", HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_THAT(refusalOf([] { return openRuntime(); }), HasSubstr("tiny.haptoflow: cannot be loaded"));
}

TEST(ModelLocationTest, AModelThatIsRefusedIsAnInputError) {
    EXPECT_THAT(refusalOf([] { return readModel("/nowhere/a.haptoflow"); }), HasSubstr("no such file"));
}

}  // namespace
}  // namespace haptoflow::cli
