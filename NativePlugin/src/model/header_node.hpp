#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::model {

/// A value of a JSON document (a model's header, a material file) with its path, so that every error names the key.
/// Refers to the JSON value. Each reader throws ModelError: oversized if a count or length is above its limit,
/// inconsistent otherwise.
class HeaderNode {
public:
    /// `document` is the document's name in errors; it must outlive the node.
    HeaderNode(const nlohmann::json& value, std::string path, const char* document = "header");

    /// The member `key`, which must exist; this node must be an object.
    [[nodiscard]] HeaderNode at(std::string_view key) const;
    /// The member `key` if it exists; this node must be an object.
    [[nodiscard]] std::optional<HeaderNode> find(std::string_view key) const;

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
    /// The value as compact JSON; it must be an object.
    [[nodiscard]] std::string objectText() const;
    /// Any value as compact JSON.
    [[nodiscard]] std::string anyText() const;

    [[noreturn]] void refuse(const std::string& expectation) const;

private:
    [[noreturn]] void refuseSize(const std::string& found, std::size_t limit) const;

    const nlohmann::json* value_;
    std::string path_;
    const char* document_;
};

}  // namespace haptoflow::model
