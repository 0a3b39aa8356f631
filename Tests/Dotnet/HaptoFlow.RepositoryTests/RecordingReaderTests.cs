using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Recordings;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Recordings as C# gets them from the native reader: files on disk and of an application, and what the
    /// wrapper adds.</summary>
    public sealed class RecordingReaderTests
    {
        private static readonly string Folder = RepositoryFiles.In("Tests", "Golden", "recordings", "files");

        [Test]
        public void FilesOfAnApplicationAreReadByTheirNames()
        {
            Dictionary<string, byte[]> files = Directory.GetFiles(MadeRecordings.DoormatFolder, "doormat*").ToDictionary(
                path => Path.GetFileName(path).Replace(".bytes", ""), File.ReadAllBytes);
            Recording recording = RecordingReader.Read("doormat.wav", files);
            Assert.That((recording.Name, recording.Label, recording.MaterialName, recording.Licence),
                Is.EqualTo(("doormat", "doormat", "doormat", "MIT")));
            Assert.That((recording.AxisCount, recording.SampleCount), Is.EqualTo((3, 21000)));
            Assert.That(recording.KnowsMotion, Is.True, "sidecar and motion file were found");
            Assert.That(recording.SampleRateHz, Is.EqualTo(2000.0).Within(1e-6));
            Assert.That(recording.Remarks, Is.Empty);
            files.Remove("doormat.motion.csv");
            var refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("doormat.wav", files))!;
            Assert.That(refusal.Status, Is.EqualTo(HaptoFlowStatus.RecordingUnusable));
            Assert.That(refusal.Message, Does.Contain("doormat.motion.csv, which is not there"));
        }

        [Test]
        public void TheFullScaleOfAWavCanBeGiven()
        {
            string path = Path.Combine(Folder, "wave_alone.wav");
            float[] weak = RecordingReader.Read(path, 10.0).Wave(1.0);
            float[] strong = RecordingReader.Read(path, 30.0).Wave(1.0);
            Assert.That(weak.Max(), Is.GreaterThan(0f));
            Assert.That(strong, Is.EqualTo(weak.Select(sample => 3f * sample)).Within(1e-3f));
        }

        [Test]
        public void MotionThatNoFileGivesCanBeAddedAndReplacesNothing()
        {
            Recording bare = RecordingReader.Read(Path.Combine(Folder, "no_motion.csv"));
            Assert.That(bare.KnowsMotion, Is.False);
            Assert.That((bare.VelocityAt(0), bare.ForceAt(0)), Is.EqualTo(((0.0, 0.0), 0.0)));
            Recording known = bare.With(0.2, 1.5);
            Assert.That(known.KnowsMotion, Is.True);
            Assert.That((known.VelocityAt(7), known.ForceAt(7)), Is.EqualTo(((0.2, 0.0), 1.5)));
            Recording own = RecordingReader.Read(Path.Combine(Folder, "constant.csv")).With(0.5, 5.0);
            Assert.That((own.VelocityAt(7), own.ForceAt(7)), Is.EqualTo(((0.08, 0.0), 1.5)));
        }

        [Test]
        public void AGapHasNoMotionAndBeyondTheEndThereIsNone()
        {
            Recording recording = RecordingReader.Read(Path.Combine(Folder, "pause.csv"));
            Assert.That((recording.VelocityAt(30000), recording.ForceAt(30000)), Is.EqualTo(((0.0, 0.0), 0.0)));
            Assert.That(recording.VelocityAt(100).X, Is.GreaterThan(0.0));
            Assert.Throws<System.ArgumentOutOfRangeException>(() => recording.ForceAt(recording.SampleCount));
        }

        [Test]
        public void AFileThatIsNotThereIsRefusedByName()
        {
            var refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("nowhere.csv"))!;
            Assert.That(refusal.Message, Does.StartWith("nowhere.csv: does not exist"));
            refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("a.csv",
                new Dictionary<string, byte[]> { ["b.csv"] = Encoding.UTF8.GetBytes("time_s\n") }))!;
            Assert.That(refusal.Message, Does.StartWith("a.csv: does not exist"));
        }
    }
}
