#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Numerics;
using Newtonsoft.Json;
using Newtonsoft.Json.Linq;

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

    /// <summary>A value of a JSON document. Reading it as another kind than it is throws a
    /// <see cref="FormatException"/> that names the value's path. Newtonsoft.Json stays behind this class, so assemblies
    /// that use HaptoFlow need no reference to it.</summary>
    public sealed class JsonValue
    {
        // Deepest nesting of arrays and objects.
        private const int MaximumDepth = 32;

        // A double holds every whole number up to here exactly.
        private const double MaximumExactInteger = 9007199254740992.0;

        private readonly JToken token;

        private JsonValue(JToken token) => this.token = token;

        /// <summary>Place in the document, for example "labels[3].name"; "the document" for the whole.</summary>
        public string Path => token.Path.Length > 0 ? token.Path : "the document";

        /// <summary>JSON null.</summary>
        public bool IsNull => token.Type == JTokenType.Null;

        internal bool IsObject => token is JObject;

        /// <summary>Null where the value is not a string.</summary>
        internal string? Text => (token as JValue)?.Value as string;

        /// <summary>Null where the value is not an array.</summary>
        internal IReadOnlyList<JsonValue>? Elements =>
            (token as JArray)?.Select(element => new JsonValue(element)).ToArray();

        /// <summary>Null where the value is not a number that a double can hold.</summary>
        internal double? Number => (token as JValue)?.Value switch
        {
            double real when Math.Abs(real) <= double.MaxValue => real,
            long whole => whole,
            BigInteger whole when BigInteger.Abs(whole) <= new BigInteger(double.MaxValue) => (double)whole,
            _ => (double?)null,
        };

        /// <summary>Null where the value is neither true nor false.</summary>
        internal bool? Truth => (token as JValue)?.Value as bool?;

        /// <summary>Parses a JSON document, nested 32 levels deep at most, no key twice in an object.</summary>
        /// <exception cref="FormatException">The text is not valid; the message names line and position.</exception>
        public static JsonValue Parse(string text)
        {
            using var reader = new JsonTextReader(new StringReader(text))
            {
                DateParseHandling = DateParseHandling.None,
                MaxDepth = MaximumDepth,
            };
            try
            {
                JToken document = JToken.Load(reader, new JsonLoadSettings
                {
                    DuplicatePropertyNameHandling = DuplicatePropertyNameHandling.Error,
                });
                // Throws where there is text after the document.
                reader.Read();
                return new JsonValue(document);
            }
            catch (JsonException error)
            {
                throw new FormatException("not valid JSON: " + error.Message, error);
            }
        }

        /// <summary>A string.</summary>
        public string AsText() => Text ?? throw Expected("a string");

        /// <summary>A number.</summary>
        public double AsNumber() => Number ?? throw Expected("a number");

        /// <summary>A whole number that fits 32 bits.</summary>
        public int AsInteger()
        {
            double number = AsNumber();
            bool whole = number == Math.Floor(number) && Math.Abs(number) <= int.MaxValue;
            return whole ? (int)number : throw Expected("a whole number");
        }

        /// <summary>A whole number from 0 to 2^64 - 1, exactly.</summary>
        public ulong AsUnsigned64() => (token as JValue)?.Value switch
        {
            long whole when whole >= 0 => (ulong)whole,
            BigInteger whole when whole.Sign >= 0 && whole <= ulong.MaxValue => (ulong)whole,
            double real when real >= 0.0 && real <= MaximumExactInteger && real == Math.Floor(real) => (ulong)real,
            _ => throw Expected("a whole number from 0 to 2^64 - 1"),
        };

        /// <summary>True or false.</summary>
        public bool AsBoolean() => Truth ?? throw Expected("true or false");

        /// <summary>An array.</summary>
        public IReadOnlyList<JsonValue> AsArray() => Elements ?? throw Expected("an array");

        /// <summary>An object, its members in the order of the text.</summary>
        public IReadOnlyDictionary<string, JsonValue> AsObject()
        {
            var members = new Dictionary<string, JsonValue>(StringComparer.Ordinal);
            foreach (KeyValuePair<string, JToken?> member in Members())
            {
                members.Add(member.Key, new JsonValue(member.Value!));
            }
            return members;
        }

        /// <summary>A member of an object.</summary>
        public JsonValue this[string key] => Find(key) ?? throw new FormatException($"{Path} has no key \"{key}\"");

        /// <summary>A member of an object; null where the object does not have it.</summary>
        public JsonValue? Find(string key) =>
            Members().TryGetValue(key, out JToken? member) ? new JsonValue(member!) : null;

        /// <summary>An element of an array.</summary>
        public JsonValue this[int index] => new JsonValue((token as JArray ?? throw Expected("an array"))[index]);

        internal FormatException Expected(string expectation) => new FormatException($"{Path} is not {expectation}");

        internal void WriteTo(JsonWriter writer) => token.WriteTo(writer);

        private JObject Members() => token as JObject ?? throw Expected("an object");
    }
}
