#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// Columns of a table that belong together, in SI units: `width` numbers for each sample. A cell without a number is
/// NaN.
struct TableSeries {
    std::size_t width = 1;
    std::vector<double> values;
    /// Names of the columns: "position_x_mm, position_y_mm".
    std::string columns;

    [[nodiscard]] std::size_t count() const { return values.size() / width; }
};

enum class MotionForm { velocity, speed, position };

/// A table of a user's own recording: columns named with their unit.
struct RecordingTable {
    std::string path;
    /// Seconds; empty without a column time_s.
    std::vector<double> timeSeconds;
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

/// Reads a CSV file. `needsAcceleration` is false for a table of motion alone. Throws InputError that names file, line
/// and column, the text found and the expected one.
[[nodiscard]] RecordingTable readRecordingTable(const std::string& path, bool needsAcceleration);

}  // namespace haptoflow::cli
