#nullable enable
using System;
using System.IO;
using System.Numerics;
using System.Text.RegularExpressions;
using Newtonsoft.Json;
using Newtonsoft.Json.Linq;

namespace HaptoFlow.Model
{
    /// <summary>Reads one JSON document as RFC 8259 defines it. Newtonsoft.Json alone also accepts comments, single
    /// quotes, trailing commas, NaN, hexadecimal numbers and other forms that the native library and Python refuse; a
    /// file must not be valid in one place and damaged in another.</summary>
    internal sealed class StrictJsonReader : JsonTextReader
    {
        /// <summary>Deepest nesting of arrays and objects.</summary>
        public const int MaximumDepth = 32;

        private const string Space = @"[ \t\r\n]*";
        private const string QuotedText = @"""(?>(?:[^""\\\x00-\x1f]+|\\[""\\/bfnrtu])*)""";
        private const string Number = @"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?";

        // A token with the white space and the comma before it, and the colon after a key.
        private static readonly Regex ValidToken = new Regex(
            "^(?:" + Space + @"[}\]]|" + Space + ",?" + Space +
            "(?:" + QuotedText + "(?:" + Space + @":)?|" + Number + @"|[{\[]|true|false|null))\z",
            RegexOptions.CultureInvariant);

        private readonly string text;
        private int line = 1;
        private int lineStart;
        private int tokenStart;

        private StrictJsonReader(string text)
            : base(new StringReader(text))
        {
            this.text = text;
            MaxDepth = MaximumDepth;
            DateParseHandling = DateParseHandling.None;
            FloatParseHandling = FloatParseHandling.Double;
        }

        /// <exception cref="JsonException">The text is not one JSON document, is nested too deeply, has a key twice in
        /// an object, or a number that a double cannot hold. The message names the place.</exception>
        public static JToken Document(string text)
        {
            using var reader = new StrictJsonReader(text);
            JToken document = JToken.Load(reader, new JsonLoadSettings
            {
                DuplicatePropertyNameHandling = DuplicatePropertyNameHandling.Error,
            });
            return reader.Read() ? throw reader.Refusal("There is text after the document") : document;
        }

        /// <inheritdoc/>
        public override bool Read()
        {
            if (!base.Read())
            {
                // The base class counts a line break at the very end twice, so TokenEnd does not hold here.
                return text.AsSpan(tokenStart).Trim(" \t\r\n").IsEmpty ? false : throw Refusal("This is not JSON");
            }
            int end = TokenEnd();
            if (!ValidToken.Match(text, tokenStart, end - tokenStart).Success)
            {
                throw Refusal("This is not JSON");
            }
            tokenStart = end;
            double number = Value is double real ? real : Value is BigInteger whole ? (double)whole : 0.0;
            return double.IsInfinity(number) ? throw Refusal("The number is out of range") : true;
        }

        /// <summary>Index into the text of the first character after the current token.</summary>
        private int TokenEnd()
        {
            for (; line < LineNumber; ++line)
            {
                int lineBreak = text.IndexOfAny(new[] { '\r', '\n' }, lineStart);
                bool isPair = text[lineBreak] == '\r' && lineBreak + 1 < text.Length && text[lineBreak + 1] == '\n';
                lineStart = lineBreak + (isPair ? 2 : 1);
            }
            return lineStart + LinePosition;
        }

        private JsonReaderException Refusal(string problem) => new JsonReaderException(FormattableString.Invariant(
            $"{problem}. Path '{Path}', line {LineNumber}, position {LinePosition}."));
    }
}
