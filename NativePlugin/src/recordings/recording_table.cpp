#include "recordings/recording_table.hpp"

#include "model/plain_text.hpp"
#include "recordings/recording.hpp"
#include "recordings/table_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace haptoflow::recordings {
namespace {

constexpr std::string_view timeColumn = "time_s";
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

std::string namesOf(const std::vector<ColumnForm>& forms) {
    std::string text;
    for (const ColumnForm& form : forms) {
        text += (text.empty() ? "" : " | ") + joined(form.columns);
    }
    return text;
}

const std::vector<std::string_view>& knownNames() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> all{timeColumn};
        for (const auto* forms : {&accelerationForms(), &allMotionForms(), &allForceForms()}) {
            for (const ColumnForm& form : *forms) {
                all.insert(all.end(), form.columns.begin(), form.columns.end());
            }
        }
        return all;
    }();
    return names;
}

bool isKnown(std::string_view name) {
    return std::ranges::find(knownNames(), name) != knownNames().end();
}

class TableReader {
public:
    TableReader(const std::string& path, const std::string& text) : path_(path), rows_(text, knownNames()) {
        if (const std::string_view encoding = otherEncoding(text); !encoding.empty()) {
            fail("is " + std::string(encoding), "a table in UTF-8: save it as CSV UTF-8");
        }
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

    /// Each name once.
    [[nodiscard]] std::vector<std::string> unknownNames() const {
        std::vector<std::string> unknown;
        for (const std::string& name : names_) {
            const std::string shown = name.empty() ? "(without a name)" : name;
            if (!isKnown(name) && std::ranges::find(unknown, shown) == unknown.end()) {
                unknown.push_back(shown);
            }
        }
        return unknown;
    }

private:
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        recordings::fail(path_, found, expected);
    }

    void readHeader() {
        const std::vector<std::string_view>& names = rows_.names();
        if (names.empty()) {
            fail("is empty", "a table (CSV) with the columns time_s and acceleration_mps2");
        }
        if (names.size() > maximumColumns) {
            fail("more than " + std::to_string(maximumColumns) + " columns", "a recording's");
        }
        for (const std::string_view name : names) {
            // In messages, which are UTF-8 whatever the file is.
            names_.push_back(model::printable(model::shortened(name, 80)));
        }
        for (const std::string& name : names_) {
            if (isKnown(name) && std::ranges::count(names_, name) > 1) {
                fail("column " + name + " twice", "it once");
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

    [[nodiscard]] double number(std::size_t column) {
        const std::string_view cell = rows_.cells()[column];
        if (isMissing(cell)) {
            return std::numeric_limits<double>::quiet_NaN();
        }
        const std::optional<double> value = rows_.decimal(column);
        if (!value) {
            throw RecordingUnusable(path_ + ":" + std::to_string(rows_.number()) + ": column " + names_[column] +
                                    ": is \"" + model::printable(model::shortened(cell, 40)) +
                                    "\"; expected a number with a decimal point");
        }
        return *value;
    }

    /// Cells of ignored columns at a row's end may be missing.
    void requireCells(std::size_t wanted) const {
        if (!(rows_.isComplete() || (rows_.cells().size() < names_.size() && rows_.cells().size() >= wanted))) {
            throw RecordingUnusable(path_ + ":" + std::to_string(rows_.number()) + ": " +
                                    std::to_string(rows_.cells().size()) + " values; expected " +
                                    std::to_string(names_.size()) +
                                    " as in the first line (decimals need a point, not a comma)");
        }
    }

    void readRows(const std::vector<std::pair<std::vector<std::size_t>, std::vector<double>*>>& wanted,
                  std::optional<std::size_t> time, RecordingTable& table) {
        std::size_t rows = 0;
        std::size_t neededCells = 0;
        for (const auto& [places, unused] : wanted) {
            neededCells = std::max(neededCells, std::ranges::max(places) + 1);
        }
        int timeDecimals = 0;
        while (rows_.next()) {
            // Separators alone are a row without numbers, which takes its time.
            if (rows_.cells().size() == 1 && rows_.isBlank()) {
                continue;
            }
            requireCells(neededCells);
            for (const auto& [places, values] : wanted) {
                for (const std::size_t column : places) {
                    values->push_back(number(column));
                }
            }
            table.lines.push_back(static_cast<std::uint32_t>(rows_.number()));
            if (time) {
                timeDecimals = std::max(timeDecimals, decimalsOf(rows_.cells()[*time]));
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
        const std::size_t point = text.find_first_of(".,");
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
    TableRows rows_;
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
