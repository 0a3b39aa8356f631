#pragma once

#include <stdexcept>
#include <string>

namespace haptoflow::model {

enum class ModelStatus {
    /// The path cannot be opened or read.
    unreadable,
    /// The first eight bytes are not the format's magic.
    notAModel,
    /// The file is shorter than the length in its first bytes.
    truncated,
    /// A format version that this reader does not know.
    tooNew,
    /// A length or a count above the format's limits.
    oversized,
    /// A checksum, a gap or the JSON syntax is wrong: the bytes were modified.
    damaged,
    /// The bytes are intact but break a rule of the format.
    inconsistent,
};

/// A model file was refused. The message names the offset or header key and the expected value.
class ModelError : public std::runtime_error {
public:
    ModelError(ModelStatus status, const std::string& message) : std::runtime_error(message), status_(status) {}

    [[nodiscard]] ModelStatus status() const noexcept { return status_; }

private:
    ModelStatus status_;
};

}  // namespace haptoflow::model
