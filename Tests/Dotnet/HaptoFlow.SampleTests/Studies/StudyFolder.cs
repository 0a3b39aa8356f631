#nullable enable
using System;
using System.IO;
using System.Linq;
using HaptoFlow.Studies;

namespace HaptoFlow.SampleTests
{
    /// <summary>A temporary folder with the logs of a small latency study.</summary>
    internal sealed class StudyFolder : IDisposable
    {
        public string Path { get; } = System.IO.Path.Combine(
            System.IO.Path.GetTempPath(), "haptoflow-study-" + System.IO.Path.GetRandomFileName());

        public FailingFiles Files { get; } = new FailingFiles();

        public string Csv => Directory.GetFiles(Path, "*.csv").Single();

        public string Sidecar => Directory.GetFiles(Path, "*.json").Single();

        public string[] Rows => File.ReadAllText(Csv).TrimEnd('\n').Split('\n').Skip(1).ToArray();

        public static StudyDescription Description(
            int participant = 7, ulong seed = 1, double amplitude = 20.0, double deviceMilliseconds = 5.0,
            string deviceDelaySource = "estimated")
        {
            StudyPlan plan = StudyPlan.Latency(participant, seed, new[] { 50.0, 70.0 });
            var settings = new StudyFields { { "tone", new StudyFields { { "amplitude_mps2", amplitude } } } };
            return new StudyDescription(plan, settings, new SystemDelay(11.1, 0.0, 10.7, deviceMilliseconds))
            {
                Device = new StudyFields
                {
                    { "device_delay_ms", deviceMilliseconds }, { "device_delay_source", deviceDelaySource },
                    { "device_delay_note", "made up" },
                },
            };
        }

        public StudyLog Open(StudyDescription? description = null) =>
            StudyLog.Open(Path, description ?? Description(), Files);

        public static TrialRecord Yes() => new TrialRecord().Set("answer", "yes");

        /// <summary>Creates a session that was interrupted after some answers.</summary>
        public void Leave(int answered)
        {
            StudyLog log = Open();
            for (int trial = 0; trial < answered; ++trial)
            {
                log.Append(Yes().Set("elapsed_seconds", 10.0 * (trial + 1)).Set("attempt", 1));
            }
        }

        public void Dispose()
        {
            if (Directory.Exists(Path))
            {
                Directory.Delete(Path, true);
            }
        }
    }

    /// <summary>A file system whose writes can be made to fail.</summary>
    internal sealed class FailingFiles : LogWriter
    {
        /// <summary>The error of every write; null for a disk that works.</summary>
        public Exception? Failure { get; set; }

        /// <summary>Number of bytes of a line that are written before a failure.</summary>
        public int RoomBytes { get; set; }

        /// <summary>Number of attempts to write.</summary>
        public int Attempts { get; private set; }

        public override void Replace(string path, string text)
        {
            Fail();
            base.Replace(path, text);
        }

        public override void AddLine(string path, byte[] before, byte[] line)
        {
            if (Failure != null)
            {
                base.AddLine(path, before, line.AsSpan(0, Math.Min(RoomBytes, line.Length)).ToArray());
            }
            Fail();
            base.AddLine(path, before, line);
        }

        private void Fail()
        {
            ++Attempts;
            if (Failure != null)
            {
                throw Failure;
            }
        }
    }
}
