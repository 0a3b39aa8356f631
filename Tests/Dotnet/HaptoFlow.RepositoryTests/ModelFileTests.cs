#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using Newtonsoft.Json.Linq;

namespace HaptoFlow.RepositoryTests
{
    public sealed class ModelHeaderTests
    {
        private static byte[] TinyModel() => File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "tiny.haptoflow"));

        [Test]
        public void TheHeaderHasTheValuesOfTheFilesText()
        {
            using HapticModel model = HapticModel.Open(File.ReadAllBytes(RepositoryFiles.DefaultModel));
            JsonValue json = JsonValue.Parse(model.HeaderJson());
            ModelHeader header = model.Header;
            Assert.That((header.Name, header.Description), Is.EqualTo((json["name"].AsText(), json["description"].AsText())));
            JsonValue provenance = json["provenance"];
            Assert.That(
                (header.Provenance.Recordings, header.Provenance.Licence, header.Provenance.Commit, header.Provenance.Created),
                Is.EqualTo((provenance["recordings"].AsText(), provenance["licence"].AsText(), provenance["commit"].AsText(),
                    provenance["created"].AsText())));
            JsonValue speeds = json["range"]["speed_mps"];
            JsonValue forces = json["range"]["force_newtons"];
            Assert.That((header.SpeedMps.Minimum, header.SpeedMps.Maximum),
                Is.EqualTo((speeds[0].AsNumber(), speeds[1].AsNumber())));
            Assert.That((header.ForceNewtons.Minimum, header.ForceNewtons.Maximum),
                Is.EqualTo((forces[0].AsNumber(), forces[1].AsNumber())));
            foreach ((HapticLabel label, JsonValue each) in header.Labels.Zip(json["labels"].AsArray(), (l, e) => (l, e)))
            {
                Assert.That((label.Name, label.Category, label.StiffnessNewtonsPerMetre, label.FrictionCoefficient),
                    Is.EqualTo((each["name"].AsText(), each["category"].AsText(),
                        each["stiffness_newtons_per_metre"].AsNumber(), each["friction_coefficient"].AsNumber())));
                Assert.That(label.WavelengthMetres,
                    Is.EqualTo(each["periodic"].AsBoolean() ? each["wavelength_metres"].AsNumber() : (double?)null));
            }
            Assert.That(header.Tiers.Select(tier => (tier.Name, tier.Kind, tier.Steps, tier.ParameterCount)),
                Is.EqualTo(json["tiers"].AsArray().Select(tier => (tier["name"].AsText(), tier["kind"].AsText(),
                    tier.Find("steps")?.AsInteger() ?? 1, (long)tier["parameters"].AsNumber()))));
            Assert.That(header.DefaultTier.Name, Is.EqualTo(json["default_tier"].AsText()));
        }

        [TestCase(0, (int)'X', HaptoFlowStatus.NotAModel, "not a .haptoflow file")]
        [TestCase(28, 0, HaptoFlowStatus.ModelDamaged, "checksum at byte 28")]
        [TestCase(40, 0, HaptoFlowStatus.ModelDamaged, "checksum at byte 24")]
        public void TheLibrarysRefusalIsPassedOn(int position, int value, HaptoFlowStatus status, string message)
        {
            byte[] damaged = TinyModel();
            damaged[position] = (byte)(value == 0 ? ~damaged[position] : value);
            var refusal = Assert.Throws<HaptoFlowException>(() => ModelHeader.Read(damaged));
            Assert.That(refusal!.Status, Is.EqualTo(status));
            Assert.That(refusal.Message, Does.Contain(message));
        }

        [Test]
        public void NearMatchesFindMisspeltAndPartialNames()
        {
            var names = new LabelNames(new[] { "metal mesh", "cork", "wood", "denim" });
            Assert.That(names.TryFind("Metal Mesh", out int index), Is.True);
            Assert.That(index, Is.Zero);
            Assert.That(names.TryFind("korc", out _), Is.False);
            Assert.That(names.NearMatches("korc"), Is.EqualTo(new[] { "cork" }));
            Assert.That(names.NearMatches("mesh"), Is.EqualTo(new[] { "metal mesh" }));
            Assert.That(names.NearMatches("granite"), Is.Empty);
        }
    }

    public sealed class LabelSpellingTests
    {
        private static readonly string[][] Groups = JArray
            .Parse(File.ReadAllText(Path.Combine(RepositoryFiles.Root, "Tests", "Golden", "labels", "labels.json")))
            .Select(group => group.Select(spelling => (string)spelling!).ToArray())
            .ToArray();

        [Test]
        public void SpellingsOfOneLabelAreTheSameAndThoseOfTwoAreNotByTheGoldenFile()
        {
            var names = new LabelNames(Groups.Select(group => group[0]));
            Assert.That(Groups, Has.Length.GreaterThan(20));
            for (int expected = 0; expected < Groups.Length; ++expected)
            {
                foreach (string spelling in Groups[expected])
                {
                    Assert.That(names.TryFind(spelling, out int index), Is.True, spelling);
                    Assert.That(index, Is.EqualTo(expected), spelling);
                    Assert.That(names.TryFind(spelling, out int again) && again == index, Is.True, spelling);
                }
            }
            Assert.That(names.TryFind("ahren", out _), Is.False);
            Assert.That(names.TryFind("ahren", out _), Is.False, "asked again");
        }

        [Test]
        public void ASpellingThatWasAskedBeforeCostsNoGarbage()
        {
            var names = new LabelNames(new[] { "wood", "\u00e4hre" });
            Assert.That(names.TryFind("A\u0308HRE", out int index), Is.True);
            Assert.That(index, Is.EqualTo(1));
            Assert.That(AllocatedByHundredQuestions(names, "A\u0308HRE"), Is.Zero);
            Assert.That(AllocatedByHundredQuestions(names, "Wood"), Is.Zero);
        }

        [System.Runtime.CompilerServices.MethodImpl(System.Runtime.CompilerServices.MethodImplOptions.NoInlining)]
        private static long AllocatedByHundredQuestions(LabelNames names, string spelling)
        {
            names.TryFind(spelling, out _);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int question = 0; question < 100; ++question)
            {
                names.TryFind(spelling, out _);
            }
            return GC.GetAllocatedBytesForCurrentThread() - before;
        }

        [Test]
        public void HalfOfASurrogatePairIsComparedAsItIs() =>
            Assert.That(LabelSpelling.Same.Equals("w\ud83e", "W\ud83e"), Is.True);
    }

    public sealed class MaterialFileTests
    {
        private static JsonValue Expected => JsonValue.Parse(File.ReadAllText(Golden("expected.json")));

        [Test]
        public void TheSpaceOfAModelEqualsThatOfTheOtherReaders()
        {
            byte[] tiny = File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "tiny.haptoflow"));
            Assert.That(ModelHeader.Read(tiny).Space, Is.EqualTo(Expected["spaces"]["tiny"].AsText()));
            byte[] model = File.ReadAllBytes(RepositoryFiles.DefaultModel);
            Assert.That(ModelHeader.Read(model).Space, Is.EqualTo(Expected["spaces"]["default"].AsText()));
        }

        [TestCase("smooth", "stick_slip")]
        [TestCase("ruled", "rib_wander")]
        public void ALabelOfAModelWithASkeletonKeepsTheWavesOfItsSurfaceAndHasNoSeeds(string label, string key)
        {
            byte[] file = File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "skeleton.haptoflow"));
            JObject material = JObject.Parse(MaterialText.OfLabel(file, label));
            using HapticModel model = HapticModel.Open(file);
            JToken stated = JObject.Parse(model.HeaderJson())["labels"]!.Single(each => (string?)each["name"] == label);
            Assert.That(NumbersOf(material[key]!), Is.EqualTo(NumbersOf(stated[key]!)).And.Not.Empty);
            Assert.That(material.ContainsKey("seeds"), Is.False);
            Assert.That(MaterialFile.Read(material.ToString()).Name, Is.EqualTo(label));
        }

        /// <summary>The numbers of a token with their paths in it: 0 and 0.0 are equal.</summary>
        private static (string, double)[] NumbersOf(JToken token) => ((JContainer)token).Descendants().OfType<JValue>()
            .Select(number => (number.Path.Substring(token.Path.Length), (double)number)).ToArray();

        [TestCase("denim")]
        [TestCase("plain-twin")]
        [TestCase("ribbed")]
        public void AMaterialFileContainsNameSpaceAndLicence(string name)
        {
            MaterialFile material = MaterialFile.Read(File.ReadAllText(Golden(name + ".haptomaterial")));
            JsonValue expected = Expected["materials"][name];
            Assert.That(material.Name, Is.EqualTo(expected["name"].AsText()));
            Assert.That(material.Space, Is.EqualTo(expected["space"].AsText()));
            Assert.That(material.Licence, Is.EqualTo(name == "plain-twin" ? "unknown" : "MIT"));
            Assert.That(material.Seconds, Is.EqualTo(name == "plain-twin" ? 0.0 : 12.5));
        }

        [TestCase("")]
        [TestCase("[]")]
        [TestCase("{\"format\": \"haptoflow-material\"")]
        [TestCase("\u0000\u0001")]
        public void TextThatIsNoMaterialFileIsRefused(string text) =>
            Assert.That(Assert.Throws<HaptoFlowException>(() => MaterialFile.Read(text))!.Status,
                Is.EqualTo(HaptoFlowStatus.MaterialInvalid));

        private static string Golden(string name) => RepositoryFiles.In("Tests", "Golden", "material", name);
    }

    public sealed class JsonTests
    {
        [TestCase("", "Error reading JToken")]
        [TestCase("{\"a\": 1, \"a\": 2}", "name 'a' already exists")]
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
            Assert.That(value["list"].Text, Is.Null);
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
                ["a\"\\ä"] = "a\"\\ä\u0001",
            });
            Assert.That(text, Is.EqualTo("{\"whole\":5,\"single\":0.1,\"numbers\":[-1.5,1E-07,18446744073709551615,3," +
                "true,null],\"fields\":{},\"a\\\"\\\\ä\":\"a\\\"\\\\ä\\u0001\"}"));
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
