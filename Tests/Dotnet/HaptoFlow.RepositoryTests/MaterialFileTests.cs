using System;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;
using Newtonsoft.Json.Linq;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
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
