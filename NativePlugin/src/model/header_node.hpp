#pragma once

#include "model/model_header.hpp"

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::model {

/// Maximum nesting of objects and arrays in a document.
inline constexpr int maximumJsonDepth = 32;

/// Parses strict JSON of at most maximumJsonDepth levels in which no object has a key twice. Throws ModelError: damaged
/// for broken syntax or text that is not UTF-8, oversized for the depth, inconsistent for a repeated key. `document` is
/// the text's name in messages.
[[nodiscard]] nlohmann::json parseBoundedJson(std::string_view text, std::string_view document = "the JSON header");

/// A value of a JSON document (a model's header, a material file, an actuator profile) with its path, so that every
/// error names the key. Refers to the JSON value. Each reader throws ModelError: oversized if a count or length is
/// above its limit, inconsistent otherwise.
class HeaderNode {
public:
    /// `document` is the document's name in errors; it must outlive the node.
    HeaderNode(const nlohmann::json& value, std::string path, const char* document = "header");

    /// The member `key`, which must exist; this node must be an object.
    [[nodiscard]] HeaderNode at(std::string_view key) const;
    /// The member `key` if it exists; this node must be an object.
    [[nodiscard]] std::optional<HeaderNode> find(std::string_view key) const;
    /// This node must be an object without other keys.
    void requireKnown(std::initializer_list<std::string_view> keys) const;

    /// The elements of an array of `minimum` to `maximum` elements.
    [[nodiscard]] std::vector<HeaderNode> elements(std::size_t minimum, std::size_t maximum) const;
    /// An array of exactly `count` numbers, each in [minimum, maximum].
    [[nodiscard]] std::vector<double> numbers(std::size_t count, double minimum, double maximum) const;
    /// An array of `minimumCount` to `maximumCount` strictly increasing numbers, each in [minimum, maximum].
    [[nodiscard]] std::vector<double> risingNumbers(std::size_t minimumCount, std::size_t maximumCount, double minimum,
                                                    double maximum) const;

    [[nodiscard]] double number(double minimum, double maximum) const;
    [[nodiscard]] std::int64_t integer(std::int64_t minimum, std::int64_t maximum) const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] bool isNull() const;
    /// A string of at most `maximumBytes` bytes without control characters.
    [[nodiscard]] std::string text(std::size_t maximumBytes) const;
    /// A string like that of `text`, with at least one character.
    [[nodiscard]] std::string name(std::size_t maximumBytes) const;
    /// A date as YYYY-MM-DD, or an empty string.
    [[nodiscard]] std::string date() const;
    /// The value as compact JSON; it must be an object.
    [[nodiscard]] std::string objectText() const;

    [[noreturn]] void refuse(const std::string& expectation) const;

private:
    /// Also says what was found.
    [[noreturn]] void refuseValue(const std::string& expectation) const;
    [[noreturn]] void refuseSize(const std::string& found, std::size_t limit) const;

    const nlohmann::json* value_;
    std::string path_;
    const char* document_;
};

/// Maximum length in bytes of the name of a model, label, tier or blob.
inline constexpr std::size_t nameBytes = 128;

/// Reads the keys that labels and material files have in common: all of a label but its name and its embedding row.
/// Throws ModelError.
void readLabelTraits(const HeaderNode& node, Label& label);

/// Reads one element of the header's "labels"; its embedding row must be below `embeddingRows`. Throws ModelError.
[[nodiscard]] Label readLabel(const HeaderNode& node, std::size_t embeddingRows);

}  // namespace haptoflow::model
