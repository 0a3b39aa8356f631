#nullable enable
using System;
using System.IO;
using System.Linq;
using System.Text;
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
        public void TheDefaultModelsHeaderContainsItsProvenance()
        {
            ModelHeader header = ModelHeader.Read(File.ReadAllBytes(RepositoryFiles.DefaultModel));
            Assert.That(header.Provenance.Statement, Is.EqualTo("trained on synthetic recordings"));
            Assert.That(header.Labels.Select(label => label.Name), Does.Contain("wood").Or.Contain("oak"));
            Assert.That(header.Tiers.Select(tier => tier.Name), Is.SubsetOf(new[] { "sketch", "draft", "standard" }));
            Assert.That(header.SpeedMps.Minimum, Is.LessThan(header.SpeedMps.Maximum));
        }

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

        [Test]
        public void AWrittenMaterialFileIsReadUnchanged()
        {
            JsonValue document = JsonValue.Parse(File.ReadAllText(Golden("ribbed.haptomaterial")));
            string written = JsonText.Of(document);
            Assert.That(JsonText.Of(JsonValue.Parse(written)), Is.EqualTo(written));
            Assert.That(MaterialFile.Read(written).Embedding, Is.EqualTo(
                MaterialFile.Read(File.ReadAllText(Golden("ribbed.haptomaterial"))).Embedding));
            const string awkward = "{\"a\\\"\\\\\\u0001\u00e4\":[null,true,-0.1,1E-07,\"\"],\"b\":{},\"c\":[]}";
            Assert.That(JsonText.Of(JsonValue.Parse(awkward)), Is.EqualTo(awkward));
        }

        private static string Golden(string name) => RepositoryFiles.In("Tests", "Golden", "material", name);
    }
}
