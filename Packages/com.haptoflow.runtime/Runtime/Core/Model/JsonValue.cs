#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Model
{
    /// <summary>A JSON value. Reading one as a kind that it is not throws <see cref="FormatException"/>, which names
    /// the
    /// value's path.</summary>
    public sealed class JsonValue
    {
        /// <summary>Up to here a double holds every whole number; larger ones are kept as 64 bits.</summary>
        internal const ulong LargestExactInteger = 1ul << 53;

        private readonly object? content;

        internal JsonValue(object? content, string path)
        {
            this.content = content;
            Path = path;
        }

        /// <summary>Where it is, for example "labels[3].name"; "the document" for the whole.</summary>
        public string Path { get; }

        /// <summary>Null, a bool, a double, a ulong above <see cref="LargestExactInteger"/>, a string, a list of values
        /// or a dictionary of them.</summary>
        internal object? Content => content;

        /// <summary>JSON null.</summary>
        public bool IsNull => content == null;

        /// <summary>Parses strict JSON, 32 levels deep at most, no key twice in an object.</summary>
        /// <exception cref="FormatException">The text is not that; the message says where.</exception>
        public static JsonValue Parse(string text) => new JsonParser(text).Document();

        /// <summary>A string.</summary>
        public string AsText() => content as string ?? throw Expected("a string");

        /// <summary>A number.</summary>
        public double AsNumber() => content switch
        {
            double number => number,
            ulong whole => whole,
            _ => throw Expected("a number"),
        };

        /// <summary>A whole number that fits 32 bits.</summary>
        public int AsInteger()
        {
            double number = AsNumber();
            bool whole = number == Math.Floor(number) && Math.Abs(number) <= int.MaxValue;
            return whole ? (int)number : throw Expected("a whole number");
        }

        /// <summary>A whole number from 0 to 2^64 - 1, exactly.</summary>
        public ulong AsUnsigned64()
        {
            if (content is ulong large)
            {
                return large;
            }
            bool fits = content is double number && number >= 0.0 && number <= LargestExactInteger &&
                number == Math.Floor(number);
            return fits ? (ulong)(double)content! : throw Expected("a whole number from 0 to 2^64 - 1");
        }

        /// <summary>True or false.</summary>
        public bool AsBoolean() => content is bool truth ? truth : throw Expected("true or false");

        /// <summary>An array.</summary>
        public IReadOnlyList<JsonValue> AsArray() => content as List<JsonValue> ?? throw Expected("an array");

        /// <summary>An object.</summary>
        public IReadOnlyDictionary<string, JsonValue> AsObject() =>
            content as Dictionary<string, JsonValue> ?? throw Expected("an object");

        /// <summary>A member of an object.</summary>
        public JsonValue this[string key] => AsObject().TryGetValue(key, out JsonValue? value)
            ? value
            : throw new FormatException($"{Path} has no key \"{key}\"");

        /// <summary>A member of an object; null where it is not there.</summary>
        public JsonValue? Find(string key) => AsObject().TryGetValue(key, out JsonValue? value) ? value : null;

        /// <summary>An element of an array.</summary>
        public JsonValue this[int index] => AsArray()[index];

        internal FormatException Expected(string expectation) => new FormatException($"{Path} is not {expectation}");
    }
}
