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
                Token(value).WriteTo(writer);
            }
            return text.ToString();
        }

        private static JToken Token(object? value) => value switch
        {
            null => JValue.CreateNull(),
            JsonValue parsed => parsed.Token,
            bool truth => new JValue(truth),
            string words => new JValue(words),
            float number when !float.IsNaN(number) && !float.IsInfinity(number) => new JValue(number),
            double number when !double.IsNaN(number) && !double.IsInfinity(number) => new JValue(number),
            int number => new JValue(number),
            ulong number => new JValue(number),
            IEnumerable<KeyValuePair<string, JsonValue>> members =>
                new JObject(members.Select(member => new JProperty(member.Key, member.Value.Token))),
            IEnumerable<KeyValuePair<string, object?>> members =>
                new JObject(members.Select(member => new JProperty(member.Key, Token(member.Value)))),
            IEnumerable elements => new JArray(elements.Cast<object?>().Select(Token)),
            _ => throw new ArgumentException($"JSON has no form for {value}", nameof(value)),
        };

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

        private JsonValue(JToken token) => Token = token;

        internal JToken Token { get; }

        /// <summary>Place in the document, for example "labels[3].name"; "the document" for the whole.</summary>
        public string Path => Token.Path.Length > 0 ? Token.Path : "the document";

        /// <summary>JSON null.</summary>
        public bool IsNull => Token.Type == JTokenType.Null;

        internal bool IsObject => Token is JObject;

        internal string? Text => (Token as JValue)?.Value as string;

        internal IReadOnlyList<JsonValue>? Elements =>
            (Token as JArray)?.Select(element => new JsonValue(element)).ToArray();

        /// <summary>Null where the value is not a number that a double can hold.</summary>
        internal double? Number => (Token as JValue)?.Value switch
        {
            double real when Math.Abs(real) <= double.MaxValue => real,
            long whole => whole,
            BigInteger whole when BigInteger.Abs(whole) <= new BigInteger(double.MaxValue) => (double)whole,
            _ => (double?)null,
        };

        internal bool? Truth => (Token as JValue)?.Value as bool?;

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
        public ulong AsUnsigned64() => (Token as JValue)?.Value switch
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
        public JsonValue this[int index] => new JsonValue((Token as JArray ?? throw Expected("an array"))[index]);

        internal FormatException Expected(string expectation) => new FormatException($"{Path} is not {expectation}");

        private JObject Members() => Token as JObject ?? throw Expected("an object");
    }
}
