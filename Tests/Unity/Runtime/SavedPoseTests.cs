#nullable enable
using System.IO;
using HaptoFlow.Alignment;
using HaptoFlow.Numerics;
using NUnit.Framework;

namespace HaptoFlow.Tests
{
    /// <summary>A saved pose is read back unchanged, and a damaged file is refused.</summary>
    public sealed class SavedPoseTests
    {
        private string folder = "";
        private string path = "";

        [SetUp]
        public void MakeAFolder()
        {
            folder = Path.Combine(Path.GetTempPath(), "haptoflow-pose-" + Path.GetRandomFileName());
            path = Path.Combine(folder, "deep", "desk.json");
        }

        [TearDown]
        public void RemoveIt()
        {
            if (Directory.Exists(folder))
            {
                Directory.Delete(folder, true);
            }
        }

        [Test]
        public void ASavedPoseIsReadBackExactlyAlsoAfterOverwriting()
        {
            SavedPose.Write(path, RigidPose.Identity);
            var pose = new RigidPose(new Double3(0.1, -1.0 / 3.0, 1e-9), new Rotation(0.1, 0.2, -0.3, 0.9).Unit);
            SavedPose.Write(path, pose);
            Assert.That(SavedPose.TryRead(path, out RigidPose read, out string? problem), Is.True);
            Assert.That(problem, Is.Null);
            Assert.That(read.PositionMetres, Is.EqualTo(pose.PositionMetres));
            Assert.That(read.Rotation.W, Is.EqualTo(pose.Rotation.W).Within(1e-15));
            Assert.That(Directory.GetFiles(Path.GetDirectoryName(path)!), Has.Length.EqualTo(1), "no temporary file " +
                "remains");
        }

        [Test]
        public void AMissingFileIsNotAnError()
        {
            Assert.That(SavedPose.TryRead(path, out _, out string? problem), Is.False);
            Assert.That(problem, Is.Null);
        }

        [TestCase("")]
        [TestCase("{}")]
        [TestCase("{\"format\": \"haptoflow pose\", \"version\": 2, \"position_m\": [0, 0, 0], " +
            "\"rotation_xyzw\": [0, 0, 0, 1]}")]
        [TestCase("{\"format\": \"haptoflow pose\", \"version\": 1, \"position_m\": [0, 0], " +
            "\"rotation_xyzw\": [0, 0, 0, 1]}")]
        [TestCase("{\"format\": \"haptoflow pose\", \"version\": 1, \"position_m\": [0, 1e9, 0], " +
            "\"rotation_xyzw\": [0, 0, 0, 1]}")]
        [TestCase("{\"format\": \"haptoflow pose\", \"version\": 1, \"position_m\": [0, 0, 0], " +
            "\"rotation_xyzw\": [0, 0, 0, 0]}")]
        [TestCase("{\"format\": \"haptoflow pose\", \"version\": 1, \"position_m\": [0, 0, 0], " +
            "\"rotation_xyzw\": [0, 0, 0, 1]")]
        public void ADamagedFileIsRefusedWithItsNameAndTheRemedy(string text)
        {
            Directory.CreateDirectory(Path.GetDirectoryName(path)!);
            File.WriteAllText(path, text);
            Assert.That(SavedPose.TryRead(path, out _, out string? problem), Is.False);
            Assert.That(problem, Does.StartWith(path).And.EndWith("align again"));
        }

        [Test]
        public void ATooLongFileIsNotRead()
        {
            Directory.CreateDirectory(Path.GetDirectoryName(path)!);
            File.WriteAllText(path, new string(' ', 5000));
            Assert.That(SavedPose.TryRead(path, out _, out string? problem), Is.False);
            Assert.That(problem, Does.Contain("longer"));
        }
    }
}
