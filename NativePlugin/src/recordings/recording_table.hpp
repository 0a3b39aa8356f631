#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::recordings {

/// Columns of a table that belong together, in SI units: `width` numbers for each row. A cell without a number is NaN.
struct TableSeries {
    std::size_t width = 1;
    std::vector<double> values;
    /// Names of the columns: "position_x_mm, position_y_mm".
    std::string columns;

    [[nodiscard]] std::size_t count() const { return values.size() / width; }
    /// The first of the columns.
    [[nodiscard]] std::string column() const { return columns.substr(0, columns.find(',')); }
};

enum class MotionForm { velocity, speed, position };

/// A table of a user's own recording: columns named with their unit.
struct RecordingTable {
    /// Of the file, for messages.
    std::string path;
    /// Seconds; empty without a column time_s.
    std::vector<double> timeSeconds;
    /// The largest error that the digits of time_s leave, in s; 0 without the column.
    double timeRoundingSeconds = 0.0;
    /// Line of each row in the file, from 1.
    std::vector<std::uint32_t> lines;
    /// m/s^2; of width 1 or 3.
    std::optional<TableSeries> acceleration;
    /// m/s (width 2 or, for a speed, 1) or metres (width 2).
    std::optional<TableSeries> motion;
    MotionForm motionForm = MotionForm::velocity;
    /// N.
    std::optional<TableSeries> force;
    /// Names of unknown columns, which are ignored.
    std::vector<std::string> unknown;
};

/// The possible columns of motion and of force, for messages.
[[nodiscard]] std::string motionForms();
[[nodiscard]] std::string forceForms();

/// Reads a CSV text. `path` is its file's in messages. `needsAcceleration` is false for a table of motion alone. Throws
/// RecordingUnusable that names file, line and column, the text found and the expected one.
[[nodiscard]] RecordingTable readRecordingTable(const std::string& path, const std::string& text,
                                                bool needsAcceleration);

/// The columns of a CSV text that no form names, by its first line alone. Throws as readRecordingTable.
[[nodiscard]] std::vector<std::string> unknownColumns(const std::string& path, const std::string& text);

}  // namespace haptoflow::recordings
