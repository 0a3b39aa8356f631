#pragma once

#include "model/model_error.hpp"
#include "model/model_file.hpp"
#include "model_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

namespace haptoflow::model::testing {

/// Expects that the reader refuses `file` with `status` and a message that contains `part`.
inline void expectRefusal(Bytes file, ModelStatus status, const std::string& part) {
    try {
        (void)ModelFile::parse(std::move(file));
        ADD_FAILURE() << "the file was accepted; expected a refusal that mentions: " << part;
    } catch (const ModelError& error) {
        EXPECT_EQ(error.status(), status) << error.what();
        EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
    }
}

/// Expects the same for the valid model with a changed header and correct checksums.
inline void expectHeaderRefusal(const std::function<void(nlohmann::json&)>& change, const std::string& part,
                                ModelStatus status = ModelStatus::inconsistent) {
    ModelBuilder builder;
    change(builder.header);
    expectRefusal(builder.build(), status, part);
}

/// Expects the same for the valid model with this value at a place of the header.
inline void expectHeaderRefusal(const std::string& pointer, const nlohmann::json& value, const std::string& part,
                                ModelStatus status = ModelStatus::inconsistent) {
    expectHeaderRefusal([&](nlohmann::json& header) { header[nlohmann::json::json_pointer(pointer)] = value; }, part,
                        status);
}

/// Expects the same for a change of the header's list of blobs.
inline void expectBlobRefusal(const std::function<void(nlohmann::json& blobs)>& change, const std::string& part,
                              ModelStatus status = ModelStatus::inconsistent) {
    ModelBuilder builder;
    builder.editLaidOut = [&change](nlohmann::json& header) { change(header["blobs"]); };
    expectRefusal(builder.build(), status, part);
}

}  // namespace haptoflow::model::testing
