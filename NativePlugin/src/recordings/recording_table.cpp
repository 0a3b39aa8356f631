#include "recordings/recording_table.hpp"

#include "recordings/csv_lines.hpp"
#include "recordings/decimal_number.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

namespace haptoflow::recordings {
namespace {

constexpr std::string_view timeColumn = "time_s";
constexpr double gravityMps2 = 9.80665;
constexpr std::size_t maximumColumns = 256;
constexpr std::size_t maximumRows = 60'000'000;

struct ColumnForm {
    std::vector<std::string> columns;
    double factor = 1.0;
    MotionForm motion = MotionForm::velocity;
};

const std::vector<ColumnForm>& accelerationForms() {
    static const std::vector<ColumnForm> forms{
        {{"acceleration_mps2"}, 1.0},
        {{"acceleration_g"}, gravityMps2},
        {{"acceleration_x_mps2", "acceleration_y_mps2", "acceleration_z_mps2"}, 1.0},
        {{"acceleration_x_g", "acceleration_y_g", "acceleration_z_g"}, gravityMps2}};
    return forms;
}

const std::vector<ColumnForm>& allMotionForms() {
    static const std::vector<ColumnForm> forms{{{"velocity_x_mps", "velocity_y_mps"}, 1.0, MotionForm::velocity},
                                               {{"speed_mps"}, 1.0, MotionForm::speed},
                                               {{"speed_mmps"}, 1e-3, MotionForm::speed},
                                               {{"position_x_mm", "position_y_mm"}, 1e-3, MotionForm::position},
                                               {{"position_x_m", "position_y_m"}, 1.0, MotionForm::position}};
    return forms;
}

const std::vector<ColumnForm>& allForceForms() {
    static const std::vector<ColumnForm> forms{{{"force_newtons"}, 1.0}, {{"force_millinewtons"}, 1e-3}};
    return forms;
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : ", ") + word;
    }
    return text;
}

std::string namesOf(const std::vector<ColumnForm>& forms) {
    std::string text;
    for (const ColumnForm& form : forms) {
        text += (text.empty() ? "" : " | ") + joined(form.columns);
    }
    return text;
}

std::string_view bareCell(std::string_view text) {
    return trimmed(text, " \t\r\"");
}

class TableReader {
public:
    TableReader(const std::string& path, const std::string& text) : path_(path), lines_(text) {
        refuseOtherEncodings(text);
        readHeader();
    }

    RecordingTable read(bool needsAcceleration) {
        RecordingTable table;
        table.path = path_;
        const std::optional<ColumnForm> acceleration = formIn(accelerationForms(), "acceleration");
        const std::optional<ColumnForm> motion = formIn(allMotionForms(), "motion");
        const std::optional<ColumnForm> force = formIn(allForceForms(), "force");
        if (needsAcceleration && !acceleration) {
            fail("columns " + joined(names_), "acceleration: " + namesOf(accelerationForms()));
        }
        table.unknown = unknownNames();
        const std::optional<std::size_t> time = place(timeColumn);
        std::vector<std::pair<std::vector<std::size_t>, std::vector<double>*>> wanted;
        const auto want = [&](const std::optional<ColumnForm>& form, std::optional<TableSeries>& series) {
            if (form) {
                series.emplace();
                series->width = form->columns.size();
                series->columns = joined(form->columns);
                wanted.emplace_back(placesOf(*form), &series->values);
            }
        };
        if (needsAcceleration) {
            want(acceleration, table.acceleration);
        }
        want(motion, table.motion);
        want(force, table.force);
        if (time) {
            wanted.emplace_back(std::vector<std::size_t>{*time}, &table.timeSeconds);
        }
        readRows(wanted, time, table);
        scale(acceleration, table.acceleration);
        scale(motion, table.motion);
        scale(force, table.force);
        table.motionForm = motion ? motion->motion : MotionForm::velocity;
        return table;
    }

    [[nodiscard]] std::vector<std::string> unknownNames() const {
        std::vector<std::string> unknown;
        for (const std::string& name : names_) {
            const auto knows = [&](const std::vector<ColumnForm>& forms) {
                return std::ranges::any_of(forms, [&](const ColumnForm& form) {
                    return std::ranges::find(form.columns, name) != form.columns.end();
                });
            };
            if (name != timeColumn && !knows(accelerationForms()) && !knows(allMotionForms()) &&
                !knows(allForceForms())) {
                unknown.push_back(name);
            }
        }
        return unknown;
    }

private:
    void refuseOtherEncodings(const std::string& text) const {
        constexpr std::string_view zeroByte("\0", 1);
        if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
            fail("is text in UTF-16", "UTF-8: save the table as CSV UTF-8");
        }
        if (text.find(zeroByte) != std::string::npos) {
            fail("is not text: it has bytes of zero", "a table (CSV) in UTF-8");
        }
    }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw RecordingUnusable(path_ + ": " + found + "; expected " + expected);
    }

    void readHeader() {
        if (!lines_.next()) {
            fail("is empty", "a table (CSV) with the columns time_s and acceleration_mps2");
        }
        const std::string_view line = lines_.line();
        if (line.find(';') != std::string_view::npos && line.find(',') == std::string_view::npos) {
            fail("columns separated by semicolons", "commas between columns and points in numbers");
        }
        if (static_cast<std::size_t>(std::ranges::count(line, ',')) >= maximumColumns) {
            fail("more than " + std::to_string(maximumColumns) + " columns", "a recording's");
        }
        std::vector<std::string_view> cells;
        splitCells(line, cells);
        for (const std::string_view cell : cells) {
            names_.emplace_back(bareCell(cell).substr(0, 80));
        }
        for (const std::string& name : names_) {
            if (std::ranges::count(names_, name) > 1) {
                fail("column " + name + " twice", "each column once");
            }
        }
    }

    [[nodiscard]] std::optional<std::size_t> place(std::string_view name) const {
        const auto found = std::ranges::find(names_, name);
        return found == names_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names_.begin()));
    }

    [[nodiscard]] std::vector<std::size_t> placesOf(const ColumnForm& form) const {
        std::vector<std::size_t> places;
        for (const std::string& name : form.columns) {
            places.push_back(*place(name));
        }
        return places;
    }

    [[nodiscard]] std::optional<ColumnForm> formIn(const std::vector<ColumnForm>& forms,
                                                   const std::string& what) const {
        const auto isThere = [&](const std::string& name) { return place(name).has_value(); };
        std::optional<ColumnForm> found;
        for (const ColumnForm& form : forms) {
            if (std::ranges::none_of(form.columns, isThere)) {
                continue;
            }
            if (found) {
                fail(what + " in several forms (" + joined(found->columns) + " and " + joined(form.columns) + ")",
                     "one of " + namesOf(forms));
            }
            for (const std::string& name : form.columns) {
                if (!isThere(name)) {
                    fail("columns " + joined(names_) + " without " + name, joined(form.columns));
                }
            }
            found = form;
        }
        return found;
    }

    [[nodiscard]] double number(std::string_view cell, std::size_t column) const {
        const std::string_view text = bareCell(cell);
        if (text.empty() || text == "nan" || text == "NaN" || text == "NA" || text == "inf" || text == "-inf") {
            return std::numeric_limits<double>::quiet_NaN();
        }
        const std::optional<double> value = decimalNumber(text);
        if (!value) {
            throw RecordingUnusable(path_ + ":" + std::to_string(lines_.number()) + ": column " + names_[column] +
                                    ": is \"" + std::string(text.substr(0, 40)) +
                                    "\"; expected a number with a decimal point");
        }
        return *value;
    }

    void readRows(const std::vector<std::pair<std::vector<std::size_t>, std::vector<double>*>>& wanted,
                  std::optional<std::size_t> time, RecordingTable& table) {
        std::vector<std::string_view> cells;
        std::size_t rows = 0;
        int timeDecimals = 0;
        while (lines_.next()) {
            if (bareCell(lines_.line()).empty()) {
                continue;
            }
            splitCells(lines_.line(), cells);
            if (cells.size() != names_.size()) {
                throw RecordingUnusable(path_ + ":" + std::to_string(lines_.number()) + ": " +
                                        std::to_string(cells.size()) + " values; expected " +
                                        std::to_string(names_.size()) +
                                        " as in the first line (decimals need a point, not a comma)");
            }
            for (const auto& [places, values] : wanted) {
                for (const std::size_t column : places) {
                    values->push_back(number(cells[column], column));
                }
            }
            table.lines.push_back(static_cast<std::uint32_t>(lines_.number()));
            if (time) {
                timeDecimals = std::max(timeDecimals, decimalsOf(bareCell(cells[*time])));
            }
            if (++rows > maximumRows) {
                fail("more than " + std::to_string(maximumRows) + " rows", "five minutes of recording at most");
            }
        }
        if (rows < 4) {
            fail(std::to_string(rows) + " rows", "4 rows at least");
        }
        table.timeRoundingSeconds = time ? 0.5 * std::pow(10.0, -timeDecimals) : 0.0;
    }

    /// Digits after the point; a number with an exponent has all that a double has.
    static int decimalsOf(std::string_view text) {
        constexpr int allDecimals = 17;
        const std::size_t point = text.find('.');
        return text.find_first_of("eE") != std::string_view::npos ? allDecimals
               : point == std::string_view::npos                  ? 0
                                                                  : static_cast<int>(text.size() - point - 1);
    }

    static void scale(const std::optional<ColumnForm>& form, std::optional<TableSeries>& series) {
        if (series) {
            std::ranges::transform(series->values, series->values.begin(),
                                   [&](double value) { return value * form->factor; });
        }
    }

    const std::string& path_;
    CsvLines lines_;
    std::vector<std::string> names_;
};

}  // namespace

std::string motionForms() {
    return namesOf(allMotionForms());
}

std::string forceForms() {
    return namesOf(allForceForms());
}

RecordingTable readRecordingTable(const std::string& path, const std::string& text, bool needsAcceleration) {
    return TableReader(path, text).read(needsAcceleration);
}

std::vector<std::string> unknownColumns(const std::string& path, const std::string& text) {
    return TableReader(path, text).unknownNames();
}

}  // namespace haptoflow::recordings
