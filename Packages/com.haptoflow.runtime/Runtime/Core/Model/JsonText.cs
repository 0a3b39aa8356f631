#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>Writes JSON: values that were parsed, and texts, numbers, lists and dictionaries of them.</summary>
    internal static class JsonText
    {
        /// <param name="value">Null, a bool, a string, a float, a double, an int, a ulong, a <see cref="JsonValue"/>, a
        /// list of such or pairs of a key and such.</param>
        /// <exception cref="ArgumentException">Something else, or a number that is not finite.</exception>
        public static string Of(object? value)
        {
            var text = new StringBuilder();
            Append(text, value);
            return text.ToString();
        }

        private static void Append(StringBuilder text, object? value)
        {
            switch (value)
            {
                case null:
                    text.Append("null");
                    break;
                case JsonValue parsed:
                    Append(text, parsed.Content);
                    break;
                case bool truth:
                    text.Append(truth ? "true" : "false");
                    break;
                case string words:
                    AppendText(text, words);
                    break;
                case float number when !float.IsNaN(number) && !float.IsInfinity(number):
                    text.Append(number.ToString("R", CultureInfo.InvariantCulture));
                    break;
                case double number when !double.IsNaN(number) && !double.IsInfinity(number):
                    text.Append(number.ToString("R", CultureInfo.InvariantCulture));
                    break;
                case int number:
                    text.Append(number.ToString(CultureInfo.InvariantCulture));
                    break;
                case ulong number:
                    text.Append(number.ToString(CultureInfo.InvariantCulture));
                    break;
                case IEnumerable<KeyValuePair<string, JsonValue>> members:
                    AppendMembers(text, members);
                    break;
                case IEnumerable<KeyValuePair<string, object?>> members:
                    AppendMembers(text, members);
                    break;
                case System.Collections.IEnumerable elements:
                    AppendElements(text, elements);
                    break;
                default:
                    throw new ArgumentException($"JSON has no form for {value}", nameof(value));
            }
        }

        private static void AppendMembers<T>(StringBuilder text, IEnumerable<KeyValuePair<string, T>> members)
        {
            char before = '{';
            foreach (KeyValuePair<string, T> member in members)
            {
                text.Append(before);
                AppendText(text, member.Key);
                text.Append(':');
                Append(text, member.Value);
                before = ',';
            }
            text.Append(before == '{' ? "{}" : "}");
        }

        private static void AppendElements(StringBuilder text, System.Collections.IEnumerable elements)
        {
            char before = '[';
            foreach (object? element in elements)
            {
                text.Append(before);
                Append(text, element);
                before = ',';
            }
            text.Append(before == '[' ? "[]" : "]");
        }

        private static void AppendText(StringBuilder text, string words)
        {
            text.Append('"');
            foreach (char letter in words)
            {
                if (letter == '"' || letter == '\\')
                {
                    text.Append('\\').Append(letter);
                }
                else if (letter < ' ')
                {
                    text.Append("\\u").Append(((int)letter).ToString("x4", CultureInfo.InvariantCulture));
                }
                else
                {
                    text.Append(letter);
                }
            }
            text.Append('"');
        }
    }
}
