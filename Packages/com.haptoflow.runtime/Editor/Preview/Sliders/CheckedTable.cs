#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>An object of a JSON document whose values are checked as they are read. Messages name the key and what
    /// was expected, in the same form as the native library's.</summary>
    internal sealed class CheckedTable
    {
        private readonly IReadOnlyDictionary<string, JsonValue> members;
        private readonly string path;

        public CheckedTable(JsonValue json, string path = "")
        {
            members = json.IsObject ? json.AsObject() : new Dictionary<string, JsonValue>();
            this.path = path;
        }

        /// <summary>True where the key exists and is not null.</summary>
        public bool Has(string key) => members.TryGetValue(key, out JsonValue? value) && !value.IsNull;

        public FormatException Failure(string key, string expected, string remark = "")
        {
            string found = members.ContainsKey(key) ? "is not valid" : "is missing";
            string tail = remark.Length > 0 ? "; " + remark : "";
            return new FormatException($"'{NameOf(key)}' {found}: expected {expected}{tail}");
        }

        public string Text(string key) => Value(key)?.Text ?? throw Failure(key, "a text");

        public int Integer(string key) => Value(key)?.Number is { } number && number == Math.Floor(number) &&
            Math.Abs(number) <= int.MaxValue ? (int)number : throw Failure(key, "a whole number");

        public double Number(string key, double low, double high) =>
            Value(key)?.Number is { } number && number >= low && number <= high
                ? number
                : throw Failure(key, FormattableString.Invariant($"a number from {low:R} to {high:R}"));

        /// <summary>Null where the key is missing or null.</summary>
        public double? OptionalNumber(string key, double low, double high) =>
            Has(key) ? Number(key, low, high) : (double?)null;

        public double[] Numbers(string key, int count) => NumbersOf(key, Value(key), count, -1e6, 1e6);

        /// <summary>Rows of numbers of equal length.</summary>
        public double[][] Rows(string key, int columns, double low, double high) =>
            (Value(key)?.Elements ?? throw Failure(key, "a list of rows"))
                .Select(row => NumbersOf(key, row, columns, low, high)).ToArray();

        public IReadOnlyList<CheckedTable> Tables(string key, int least, int most)
        {
            if (!(Value(key)?.Elements is { } values) || values.Count < least || values.Count > most)
            {
                throw Failure(key, $"a list of {Words(least)} to {Words(most)} tables");
            }
            if (!values.All(value => value.IsObject))
            {
                throw Failure(key, "a list of tables");
            }
            return values.Select((value, index) => new CheckedTable(value, $"{NameOf(key)}[{Words(index)}]")).ToArray();
        }

        private double[] NumbersOf(string key, JsonValue? list, int count, double low, double high)
        {
            if (!(list?.Elements is { } values) || values.Count != count)
            {
                throw Failure(key, $"a list of {Words(count)} numbers");
            }
            if (!values.All(value => value.Number >= low && value.Number <= high))
            {
                throw Failure(key, FormattableString.Invariant($"{Words(count)} numbers from {low:R} to {high:R}"));
            }
            return values.Select(value => value.AsNumber()).ToArray();
        }

        private JsonValue? Value(string key) => members.TryGetValue(key, out JsonValue? value) ? value : null;

        private string NameOf(string key) => path.Length > 0 ? path + "." + key : key;

        private static string Words(int number) => number.ToString(CultureInfo.InvariantCulture);
    }
}
