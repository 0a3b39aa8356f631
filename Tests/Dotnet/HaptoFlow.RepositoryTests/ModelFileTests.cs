using System;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

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
}
