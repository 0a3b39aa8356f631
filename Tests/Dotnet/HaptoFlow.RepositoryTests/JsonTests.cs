using System;
using System.Collections.Generic;
using HaptoFlow.Model;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    public sealed class JsonTests
    {
        [TestCase("", "Error reading JToken")]
        [TestCase("[1, 2", "Unexpected end")]
        [TestCase("{\"a\": \"b", "Unterminated string")]
        [TestCase("{\"a\": 1, \"a\": 2}", "name 'a' already exists")]
        [TestCase("{\"a\": 1 \"b\": 2}", "unexpected character")]
        [TestCase("[+1]", "Unexpected character")]
        [TestCase("[\"\\x\"]", "Bad JSON escape")]
        [TestCase("[1] x", "Additional text")]
        [TestCase("[1] [2]", "")]
        public void ATextThatIsNotJsonIsRefusedWithItsPlace(string text, string expected)
        {
            var refusal = Assert.Throws<FormatException>(() => JsonValue.Parse(text));
            Assert.That(refusal!.Message,
                Does.StartWith("not valid JSON: ").And.Contain("line ").And.Contain("position ").And.Contain(expected));
        }

        [TestCase("1e999")]
        [TestCase("-1e999")]
        [TestCase("NaN")]
        [TestCase("Infinity")]
        public void ANumberThatADoubleCannotHoldIsRefused(string number)
        {
            // Mono refuses the text as a whole, .NET the number.
            Assert.That(() => JsonValue.Parse("[" + number + "]")[0].AsNumber(), Throws.TypeOf<FormatException>());
            JsonValue value = JsonValue.Parse("[1" + new string('0', 310) + "]");
            Assert.That(() => value[0].AsNumber(), Throws.TypeOf<FormatException>());
        }

        [Test]
        public void NestingDeeperThanThirtyTwoLevelsIsRefused()
        {
            string deepest = new string('[', 32) + new string(']', 32);
            Assert.That(() => JsonValue.Parse(deepest), Throws.Nothing);
            Assert.That(() => JsonValue.Parse("[" + deepest + "]"), Throws.TypeOf<FormatException>());
            Assert.That(() => JsonValue.Parse(new string('[', 100_000)), Throws.TypeOf<FormatException>());
        }

        [Test]
        public void StringsNumbersAndPathsAreReadExactly()
        {
            JsonValue value = JsonValue.Parse("{\"text\": \"\\u00e9\\n\\\"\", \"list\": [-1.5e-3, true, null]}");
            Assert.That(value["text"].AsText(), Is.EqualTo("é\n\""));
            Assert.That(value["list"][0].AsNumber(), Is.EqualTo(-0.0015));
            Assert.That(value["list"][1].AsBoolean(), Is.True);
            Assert.That(value["list"][2].IsNull, Is.True);
            Assert.That(() => value["list"][1].AsText(),
                Throws.TypeOf<FormatException>().With.Message.EqualTo("list[1] is not a string"));
            Assert.That(() => value["gone"],
                Throws.TypeOf<FormatException>().With.Message.EqualTo("the document has no key \"gone\""));
        }

        [Test]
        public void ATextThatLooksLikeADateStaysAText()
        {
            const string date = "2026-11-23T19:00:00Z";
            Assert.That(JsonValue.Parse("[\"" + date + "\"]")[0].AsText(), Is.EqualTo(date));
        }

        [Test]
        public void IntegersOfSixtyFourBitsAreExact()
        {
            JsonValue value = JsonValue.Parse("[18446744073709551615, 9007199254740993, 18446744073709551616, -1, 3.0]");
            Assert.That(value[0].AsUnsigned64(), Is.EqualTo(ulong.MaxValue));
            Assert.That(value[1].AsUnsigned64(), Is.EqualTo(9007199254740993ul));
            Assert.That(() => value[2].AsUnsigned64(), Throws.TypeOf<FormatException>());
            Assert.That(value[2].AsNumber(), Is.EqualTo(18446744073709551616.0));
            Assert.That(() => value[3].AsUnsigned64(), Throws.TypeOf<FormatException>());
            Assert.That((value[3].AsInteger(), value[4].AsInteger()), Is.EqualTo((-1, 3)));
        }

        [Test]
        public void WrittenNumbersAreAsShortAsPossible()
        {
            string text = JsonText.Of(new Dictionary<string, object?>
            {
                ["whole"] = 5.0,
                ["single"] = 0.1f,
                ["numbers"] = new object?[] { -1.5, 1e-7, ulong.MaxValue, 3, true, null },
                ["fields"] = new Dictionary<string, object?>(),
                ["text"] = "a\"\\ä\u0001",
            });
            Assert.That(text, Is.EqualTo("{\"whole\":5,\"single\":0.1,\"numbers\":[-1.5,1E-07,18446744073709551615,3," +
                "true,null],\"fields\":{},\"text\":\"a\\\"\\\\ä\\u0001\"}"));
            Assert.That(JsonText.Of(JsonValue.Parse(text.Replace(":5,", ":5.0,"))), Is.EqualTo(text));
        }

        [TestCase(double.NaN)]
        [TestCase(double.PositiveInfinity)]
        public void ANumberThatJsonCannotHoldIsNotWritten(double number)
        {
            Assert.That(() => JsonText.Of(new object?[] { number }), Throws.ArgumentException);
            Assert.That(() => JsonText.Of((float)number), Throws.ArgumentException);
        }
    }
}
