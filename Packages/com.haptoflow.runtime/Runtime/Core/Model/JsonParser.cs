#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>A small strict JSON reader: Unity's own reads only into types known beforehand and ignores what is
    /// missing.</summary>
    internal sealed class JsonParser
    {
        private const int MaximumDepth = 32;

        private readonly string text;
        private int position;
        private int depth;

        public JsonParser(string text) => this.text = text;

        public JsonValue Document()
        {
            JsonValue value = Value("the document");
            SkipSpace();
            return position == text.Length ? value : throw Broken("text after the document");
        }

        private JsonValue Value(string path)
        {
            SkipSpace();
            char first = position < text.Length ? text[position] : throw Broken("the text ends here");
            switch (first)
            {
                case '{':
                    return new JsonValue(Nested(() => Members(path)), path);
                case '[':
                    return new JsonValue(Nested(() => Elements(path)), path);
                case '"':
                    return new JsonValue(Text(), path);
                case 't':
                    return Word("true", true, path);
                case 'f':
                    return Word("false", false, path);
                case 'n':
                    return Word("null", null, path);
                default:
                    return new JsonValue(Number(), path);
            }
        }

        private object Nested(Func<object> read)
        {
            if (++depth > MaximumDepth)
            {
                throw Broken("nested deeper than 32 levels");
            }
            ++position;
            object result = read();
            --depth;
            return result;
        }

        private object Members(string path)
        {
            string prefix = depth == 1 ? "" : path + ".";
            var members = new Dictionary<string, JsonValue>(StringComparer.Ordinal);
            if (TryTake('}'))
            {
                return members;
            }
            do
            {
                SkipSpace();
                string key = position < text.Length && text[position] == '"' ? Text() : throw Broken("expected a key");
                Take(':');
                if (!members.TryAdd(key, Value(prefix + key)))
                {
                    throw Broken($"the key \"{key}\" is there twice");
                }
            }
            while (TryTake(','));
            Take('}');
            return members;
        }

        private object Elements(string path)
        {
            var elements = new List<JsonValue>();
            if (TryTake(']'))
            {
                return elements;
            }
            do
            {
                elements.Add(Value(path + "[" + elements.Count.ToString(CultureInfo.InvariantCulture) + "]"));
            }
            while (TryTake(','));
            Take(']');
            return elements;
        }

        private JsonValue Word(string word, object? meaning, string path)
        {
            if (string.CompareOrdinal(text, position, word, 0, word.Length) != 0)
            {
                throw Broken("not a JSON value");
            }
            position += word.Length;
            return new JsonValue(meaning, path);
        }

        private object Number()
        {
            int start = position;
            TryTakeHere('-');
            if (!TryTakeHere('0'))
            {
                Digits();
            }
            if (TryTakeHere('.'))
            {
                Digits();
            }
            if (TryTakeHere('e') || TryTakeHere('E'))
            {
                if (!TryTakeHere('+'))
                {
                    TryTakeHere('-');
                }
                Digits();
            }
            string digits = text.Substring(start, position - start);
            if (ulong.TryParse(digits, NumberStyles.None, CultureInfo.InvariantCulture, out ulong whole) &&
                whole > JsonValue.LargestExactInteger)
            {
                return whole;
            }
            double number = double.Parse(digits, NumberStyles.Float, CultureInfo.InvariantCulture);
            return !double.IsInfinity(number) ? number : throw Broken("a number out of range");
        }

        private void Digits()
        {
            int start = position;
            while (position < text.Length && text[position] >= '0' && text[position] <= '9')
            {
                ++position;
            }
            if (position == start)
            {
                throw Broken("not a JSON value");
            }
        }

        private string Text()
        {
            ++position;
            var result = new StringBuilder();
            while (position < text.Length && text[position] != '"')
            {
                char letter = text[position++];
                if (letter < ' ')
                {
                    throw Broken("a control character in a string");
                }
                result.Append(letter == '\\' ? Escaped() : letter);
            }
            if (position >= text.Length)
            {
                throw Broken("a string without end");
            }
            ++position;
            return result.ToString();
        }

        private char Escaped()
        {
            char letter = position < text.Length ? text[position++] : throw Broken("a string without end");
            switch (letter)
            {
                case '"':
                case '\\':
                case '/':
                    return letter;
                case 'b':
                    return '\b';
                case 'f':
                    return '\f';
                case 'n':
                    return '\n';
                case 'r':
                    return '\r';
                case 't':
                    return '\t';
                case 'u':
                    return CodeUnit();
                default:
                    throw Broken("an unknown escape");
            }
        }

        private char CodeUnit()
        {
            bool whole = position + 4 <= text.Length;
            ushort unit = 0;
            if (!whole || !ushort.TryParse(text.Substring(position, 4), NumberStyles.AllowHexSpecifier,
                    CultureInfo.InvariantCulture, out unit))
            {
                throw Broken("an escape that is not four hexadecimal digits");
            }
            position += 4;
            return (char)unit;
        }

        private void SkipSpace()
        {
            while (position < text.Length && " \t\r\n".IndexOf(text[position]) >= 0)
            {
                ++position;
            }
        }

        private bool TryTake(char wanted)
        {
            SkipSpace();
            return TryTakeHere(wanted);
        }

        private bool TryTakeHere(char wanted)
        {
            bool there = position < text.Length && text[position] == wanted;
            position += there ? 1 : 0;
            return there;
        }

        private void Take(char wanted)
        {
            if (!TryTake(wanted))
            {
                throw Broken($"expected '{wanted}'");
            }
        }

        private FormatException Broken(string what) => new FormatException(
            string.Format(CultureInfo.InvariantCulture, "not valid JSON at character {0}: {1}", position, what));
    }
}
