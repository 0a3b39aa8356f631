#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using Newtonsoft.Json;

namespace HaptoFlow.Model
{
    /// <summary>Writes JSON on one line, without the reflection of Newtonsoft's serialiser, which IL2CPP's code
    /// stripping can break.</summary>
    internal static class JsonText
    {
        /// <param name="value">Null, a bool, a string, a float, a double, an int, a ulong, a <see cref="JsonValue"/>, a
        /// list of such or pairs of a key and such.</param>
        /// <exception cref="ArgumentException">The value is of another type, or a number that is not finite.</exception>
        public static string Of(object? value)
        {
            var text = new StringWriter(CultureInfo.InvariantCulture);
            using (var writer = new ShortNumberWriter(text))
            {
                Write(writer, value);
            }
            return text.ToString();
        }

        private static void Write(JsonWriter writer, object? value)
        {
            switch (value)
            {
                case null:
                    writer.WriteNull();
                    break;
                case JsonValue parsed:
                    parsed.WriteTo(writer);
                    break;
                case bool truth:
                    writer.WriteValue(truth);
                    break;
                case string words:
                    writer.WriteValue(words);
                    break;
                case float number when !float.IsNaN(number) && !float.IsInfinity(number):
                    writer.WriteValue(number);
                    break;
                case double number when !double.IsNaN(number) && !double.IsInfinity(number):
                    writer.WriteValue(number);
                    break;
                case int number:
                    writer.WriteValue(number);
                    break;
                case ulong number:
                    writer.WriteValue(number);
                    break;
                case IEnumerable<KeyValuePair<string, JsonValue>> members:
                    WriteMembers(writer, members);
                    break;
                case IEnumerable<KeyValuePair<string, object?>> members:
                    WriteMembers(writer, members);
                    break;
                case IEnumerable elements:
                    writer.WriteStartArray();
                    foreach (object? element in elements)
                    {
                        Write(writer, element);
                    }
                    writer.WriteEndArray();
                    break;
                default:
                    throw new ArgumentException($"JSON has no form for {value}", nameof(value));
            }
        }

        private static void WriteMembers<T>(JsonWriter writer, IEnumerable<KeyValuePair<string, T>> members)
        {
            writer.WriteStartObject();
            foreach (KeyValuePair<string, T> member in members)
            {
                writer.WritePropertyName(member.Key);
                Write(writer, member.Value);
            }
            writer.WriteEndObject();
        }

        /// <summary>Writes the double 5 as "5", not "5.0": a number reads the same whether it was computed or parsed.
        /// </summary>
        private sealed class ShortNumberWriter : JsonTextWriter
        {
            public ShortNumberWriter(TextWriter text)
                : base(text)
            {
            }

            public override void WriteValue(float value) =>
                WriteRawValue(value.ToString("R", CultureInfo.InvariantCulture));

            public override void WriteValue(double value) =>
                WriteRawValue(value.ToString("R", CultureInfo.InvariantCulture));
        }
    }
}
