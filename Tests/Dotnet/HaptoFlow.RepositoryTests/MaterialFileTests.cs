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

        [Test]
        public void EveryLabelIsNearestToItself()
        {
            byte[] file = File.ReadAllBytes(RepositoryFiles.DefaultModel);
            using HapticModel model = HapticModel.Open(file);
            foreach (HapticLabel label in model.Labels)
            {
                MaterialFile material = MaterialFile.Read(MaterialText.OfLabel(file, label.Name));
                Assert.That(material.Embedding, Is.EqualTo(model.Embedding(label.Index)));
                Assert.That(model.NearestLabel(material.Embedding), Is.EqualTo(label.Name));
            }
            Assert.Throws<ArgumentException>(() => model.NearestLabel(new double[MaterialFile.TextureNumbers]));
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

        [Test]
        public void EveryInvalidChangeIsRefusedWithItsKey()
        {
            JsonValue invalid = JsonValue.Parse(File.ReadAllText(Golden("invalid.json")));
            string sound = File.ReadAllText(Golden(invalid["of"].AsText()));
            Assert.That(invalid["cases"].AsArray().Count, Is.GreaterThan(20));
            foreach (JsonValue each in invalid["cases"].AsArray())
            {
                string broken = Patched(sound, JsonText.Of(each["patch"]));
                var refusal = Assert.Throws<HaptoFlowException>(() => MaterialFile.Read(broken), each["name"].AsText());
                Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.MaterialInvalid));
                Assert.That(refusal.Message, Does.Contain(each["key"].AsText().Split('.').Last()), each["name"].AsText());
            }
        }

        [TestCase("")]
        [TestCase("[]")]
        [TestCase("{\"format\": \"haptoflow-material\"")]
        [TestCase("\u0000\u0001")]
        public void TextThatIsNoMaterialFileIsRefused(string text) =>
            Assert.That(Assert.Throws<HaptoFlowException>(() => MaterialFile.Read(text))!.Status,
                Is.EqualTo(HaptoFlowStatus.MaterialInvalid));

        [Test]
        public void ATextOfMoreThanAMebibyteIsRefused()
        {
            string large = "{\"format\": \"" + new string('x', 1024 * 1024) + "\"}";
            Assert.That(Assert.Throws<HaptoFlowException>(() => MaterialFile.Read(large))!.Message,
                Does.Contain("the limit is 1048576"));
        }

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

        /// <summary>Applies a JSON Patch (RFC 6902) of operations "replace" and "remove", those that the file uses.
        /// </summary>
        private static string Patched(string text, string patch)
        {
            JToken document = JToken.Parse(text);
            foreach (JToken step in JArray.Parse(patch))
            {
                string[] keys = ((string)step["path"]!).Split('/').Skip(1).ToArray();
                JToken found = keys.Aggregate(document, (place, key) =>
                    place is JArray array ? array[int.Parse(key)] : place[key] ?? AddedTo((JObject)place, key));
                if ((string?)step["op"] != "remove")
                {
                    found.Replace(step["value"]!);
                }
                else if (found.Parent is JProperty property)
                {
                    property.Remove();
                }
                else
                {
                    found.Remove();
                }
            }
            return document.ToString();
        }

        private static JToken AddedTo(JObject place, string key)
        {
            place.Add(key, null);
            return place[key]!;
        }
    }
}
