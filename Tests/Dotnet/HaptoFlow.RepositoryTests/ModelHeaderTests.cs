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
            Assert.That(header.Tiers.Select(tier => tier.Name), Is.SubsetOf(new[] { "draft", "standard", "fine" }));
            Assert.That(header.SpeedMps.Minimum, Is.LessThan(header.SpeedMps.Maximum));
        }

        [Test]
        public void TheHeaderReadInCSharpAgreesWithTheNativeLibrary()
        {
            byte[] file = File.ReadAllBytes(RepositoryFiles.DefaultModel);
            ModelHeader header = ModelHeader.Read(file);
            using HapticModel model = HapticModel.Open(file);
            Assert.That(header.Labels.Select(label => label.Name), Is.EqualTo(model.Labels.Select(label => label.Name)));
            Assert.That(header.Labels.Select(label => label.StiffnessNewtonsPerMetre),
                Is.EqualTo(model.Labels.Select(label => label.StiffnessNewtonsPerMetre)));
            Assert.That(header.Labels.Select(label => label.WavelengthMetres),
                Is.EqualTo(model.Labels.Select(label => label.WavelengthMetres)));
            Assert.That(header.Labels.Select(label => label.FrictionCoefficient),
                Is.EqualTo(model.Labels.Select(label => label.FrictionCoefficient)));
            Assert.That(header.Labels.Select(label => label.Category), Is.EqualTo(model.Labels.Select(label => label.Category)));
            Assert.That(header.Tiers.Select(tier => (tier.Name, tier.Kind, tier.Steps, tier.ParameterCount)),
                Is.EqualTo(model.Tiers.Select(tier => (tier.Name, tier.Kind, tier.Steps, tier.ParameterCount))));
            Assert.That(header.DefaultTier.Name, Is.EqualTo(model.Tiers.Single(tier => tier.IsDefault).Name));
        }

        [Test]
        public void ATruncatedFileIsRefusedAtEveryLength()
        {
            byte[] file = TinyModel();
            for (int length = 0; length < file.Length; length += 7)
            {
                var refusal = Assert.Throws<HaptoFlowException>(() => ModelHeader.Read(file.AsSpan(0, length)));
                Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.ModelTruncated), $"at {length} bytes");
            }
        }

        [Test]
        public void EveryFlippedBitOfPrefixAndHeaderIsDetected()
        {
            byte[] file = TinyModel();
            int headerEnd = 32 + (int)BitConverter.ToUInt32(file, 12);
            for (int position = 0; position < headerEnd; position += 3)
            {
                file[position] ^= 0x10;
                Assert.Throws<HaptoFlowException>(() => ModelHeader.Read(file), $"at byte {position}");
                file[position] ^= 0x10;
            }
            Assert.That(ModelHeader.Read(file).Labels, Is.Not.Empty);
        }

        [Test]
        public void CSharpAndTheNativeLibraryRefuseWithTheSameStatus()
        {
            byte[] file = TinyModel();
            foreach (Action<byte[]> damage in new Action<byte[]>[]
                     {
                         bytes => bytes[0] = (byte)'X', bytes => bytes[9] = 1, bytes => bytes[40] ^= 1, bytes => bytes[28] ^= 1,
                     })
            {
                byte[] damaged = (byte[])file.Clone();
                damage(damaged);
                var here = Assert.Throws<HaptoFlowException>(() => ModelHeader.Read(damaged));
                var there = Assert.Throws<HaptoFlowException>(() => HapticModel.Open(damaged));
                Assert.That(here!.Status, Is.EqualTo(there!.Status));
                Assert.That(here.Message, Is.Not.Empty);
            }
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
