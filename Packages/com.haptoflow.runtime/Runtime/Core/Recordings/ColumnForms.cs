#nullable enable
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>Columns that belong together, and the factor that converts their numbers to SI units.</summary>
    internal sealed class ColumnForm
    {
        public ColumnForm(double factor, params string[] columns)
        {
            Factor = factor;
            Columns = columns;
        }

        public double Factor { get; }

        public string[] Columns { get; }
    }

    /// <summary>The columns of a recording's table, by name with their unit.</summary>
    internal static class ColumnForms
    {
        public const string Time = "time_s";
        public const double GravityMps2 = 9.80665;

        public static readonly ColumnForm[] Acceleration =
        {
            new ColumnForm(1.0, "acceleration_mps2"),
            new ColumnForm(GravityMps2, "acceleration_g"),
            new ColumnForm(1.0, "acceleration_x_mps2", "acceleration_y_mps2", "acceleration_z_mps2"),
            new ColumnForm(GravityMps2, "acceleration_x_g", "acceleration_y_g", "acceleration_z_g"),
        };

        public static readonly ColumnForm[] Motion =
        {
            new ColumnForm(1.0, "velocity_x_mps", "velocity_y_mps"),
            new ColumnForm(1.0, "speed_mps"),
            new ColumnForm(1e-3, "speed_mmps"),
            new ColumnForm(1e-3, "position_x_mm", "position_y_mm"),
            new ColumnForm(1.0, "position_x_m", "position_y_m"),
        };

        public static readonly ColumnForm[] Force =
        {
            new ColumnForm(1.0, "force_newtons"), new ColumnForm(1e-3, "force_millinewtons"),
        };

        /// <summary>The columns of each form, for messages.</summary>
        public static string NamesOf(IEnumerable<ColumnForm> forms) =>
            string.Join(" | ", forms.Select(form => string.Join(", ", form.Columns)));

        public static bool IsKnown(string column) => column == Time ||
            Acceleration.Concat(Motion).Concat(Force).Any(form => form.Columns.Contains(column));

        /// <summary>The form whose columns are present; null without one.</summary>
        /// <exception cref="HaptoFlowException">Columns of two forms are present, or a form is incomplete.</exception>
        public static ColumnForm? FormIn(string file, string[] names, ColumnForm[] forms, string what)
        {
            ColumnForm[] present = forms.Where(form => form.Columns.Any(names.Contains)).ToArray();
            if (present.Length > 1)
            {
                string both = string.Join(" and ", present.Select(form => string.Join(", ", form.Columns)));
                throw RecordingError.Of(file, $"{what} in several forms ({both})", "one of " + NamesOf(forms));
            }
            ColumnForm? found = present.FirstOrDefault();
            string[] missing = found?.Columns.Where(column => !names.Contains(column)).ToArray() ?? new string[0];
            return missing.Length == 0
                ? found
                : throw RecordingError.Of(file,
                    $"columns {string.Join(", ", names)} without {string.Join(", ", missing)}",
                    string.Join(", ", found!.Columns));
        }
    }
}
