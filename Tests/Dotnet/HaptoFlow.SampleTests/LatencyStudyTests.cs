using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using HaptoFlow.Model;
using HaptoFlow.Samples.LatencyStudy;
using HaptoFlow.Studies;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The delay study with a simulated participant, the real native library and real files.</summary>
    public sealed class LatencyStudyTests : SampleTest
    {
        private const int HapticChannel = 1;
        private const double DeviceRateHz = 48000.0;
        private const int BlockFrames = 256;

        private LatencyStudySettings settings = null!;
        private LatencyStudy study = null!;
        private LatencyParticipant participant = null!;
        private HapticStylus pen = null!;

        [SetUp]
        public void OpenTheStudy()
        {
            settings = ScriptableObject.CreateInstance<LatencyStudySettings>();
            settings.name = "LatencyStudySettings";
            settings.Folder = folder;
            settings.Simulated = true;
            settings.DeviceDelayMilliseconds = 10f;
            settings.strokes = 2;
            settings.moveSeconds = 0.5f;
            settings.restSeconds = 0.5f;
            AudioDevice.ChangeDevice((int)DeviceRateHz, BlockFrames, AudioSpeakerMode.Stereo);
            OpenScene();
        }

        [Test]
        public void AnInterruptedStudyLogsEveryTrialExactlyOnce()
        {
            Begin(7);
            participant.Until(() => Rows().Length == 9, 120.0);
            participant.Until(() => study.Marker.IsMoving);
            // The application ends without warning while the pen moves, and the last row is incomplete on disk.
            string torn = "10,main,turn";
            File.AppendAllText(Csv(), torn);
            World.LoadEmptyScene();
            SimulatedInput.Reset();
            OpenScene();
            Begin(7);
            Assert.That(study.Session!.Trial!.Trial, Is.EqualTo(10));
            participant.Until(() => study.Session.Phase == StudyPhase.Finished, 240.0);
            Assert.That(study.Panel.text, Does.StartWith("That was all"));

            StudyPlan plan = StudyPlan.Latency(7, settings.Seed, settings.levelsMilliseconds);
            string[] rows = Rows();
            Assert.That(rows, Has.Length.EqualTo(26));
            for (int index = 0; index < rows.Length; ++index)
            {
                PlannedTrial trial = plan.Trials[index];
                string row = rows[index];
                Assert.That(Field(row, "trial"), Is.EqualTo(trial.Trial.ToString(CultureInfo.InvariantCulture)));
                Assert.That(Field(row, "condition"), Is.EqualTo(trial.Condition));
                Assert.That(Number(row, "delay_ms"), Is.EqualTo(trial.DelayMilliseconds));
                Assert.That(Number(row, "delivered_delay_ms"), Is.EqualTo(trial.DelayMilliseconds!.Value).Within(1e-5));
                Assert.That(Number(row, "system_delay_ms"),
                    Is.EqualTo(1000.0 / World.FrameRateHz + 1000.0 * BlockFrames / DeviceRateHz + 10.0).Within(0.01));
                Assert.That(Field(row, "answer"), Is.EqualTo(trial.DelayMilliseconds >= 130.0 ? "yes" : "no"));
                Assert.That(Field(row, "attempt"), Is.EqualTo(trial.Trial == 10 ? "2" : "1"));
                Assert.That(Number(row, "starts"), Is.EqualTo(2.0));
                Assert.That(Number(row, "stops"), Is.EqualTo(2.0));
                Assert.That(Number(row, "path_mm"), Is.EqualTo(150.0).Within(8.0), row);
            }
            Assert.That(rows.Select(row => Number(row, "elapsed_seconds")), Is.Ordered);
            JsonValue sidecar = JsonValue.Parse(File.ReadAllText(Path.ChangeExtension(Csv(), ".json")));
            Assert.That(sidecar["finished"].AsBoolean(), Is.True);
            Assert.That(sidecar["simulated"].AsBoolean(), Is.True);
            Assert.That(sidecar["resumptions"].AsInteger(), Is.EqualTo(1));
            Assert.That(sidecar["device"]["device_delay_source"].AsText(), Is.EqualTo("estimated"));
            Assert.That(sidecar["device"]["block_frames"].AsInteger(), Is.EqualTo(BlockFrames));
            RecordedSession.Keep(folder, "latency");
        }

        [Test]
        public void TheToneFollowsThePenByThePlannedDelayInEveryTrial()
        {
            Begin(2);
            var recorder = new ToneRecorder(pen, HapticChannel);
            var output = camera.GetComponent<HapticOutput>();
            for (int trial = 1; trial <= 26; ++trial)
            {
                StudySession session = study.Session!;
                recorder.Begin();
                participant.Until(() => session.Trial!.Trial == trial && !output.Muted);
                Assert.That(recorder.Tones(), Is.Empty, "the output is muted on the way to the marker");
                recorder.Begin();
                double level = session.Trial!.DelayMilliseconds!.Value;
                participant.Until(() => session.Phase == StudyPhase.Question);
                double artificialFrames =
                    0.001 * DeviceRateHz * (level - study.Delay.TotalMilliseconds);
                List<(int First, int Last)> tones = recorder.Tones();
                Assert.That(recorder.Starts, Has.Count.EqualTo(2), $"trial {trial}");
                Assert.That(tones, Has.Count.EqualTo(2), $"trial {trial}: {string.Join(", ", tones)}");
                for (int tone = 0; tone < 2; ++tone)
                {
                    // The tone fades in and out within 2 ms; its first sample is zero.
                    Assert.That(tones[tone].First - recorder.Starts[tone], Is.EqualTo(artificialFrames).Within(8.0),
                        $"trial {trial}, {level} ms, start {tone}");
                    Assert.That(tones[tone].Last - recorder.Stops[tone], Is.EqualTo(artificialFrames + 96.0).Within(8.0),
                        $"trial {trial}, {level} ms, stop {tone}");
                }
            }
        }

        [Test]
        public void WithoutUnitysAudioTheStudyIsRefusedWithTheReason()
        {
            AudioDevice.IsSwitchedOff = true;
            World.Frame();
            Press(3);
            Assert.That(study.Session, Is.Null);
            Assert.That(study.View.Problem, Does.Contain("Disable Unity Audio"));
            Assert.That(Directory.Exists(folder), Is.False);
        }

        [Test]
        public void UnreachableLevelsAreRefusedBeforeAnythingIsWritten()
        {
            settings.DeviceDelayMilliseconds = 60f;
            Press(3);
            Assert.That(study.Session, Is.Null);
            Assert.That(study.View.Problem, Does.StartWith("the delay level 50, 70 ms cannot be reached").And
                .Contain("device 60.0"));
            Assert.That(Directory.Exists(folder), Is.False);
            settings.levelsMilliseconds = new[] { 90.0, 130.0, 250.0 };
            Press(3);
            Assert.That(study.View.Problem, Is.Null);
            Assert.That(study.Session, Is.Not.Null);
        }

        [Test]
        public void TheOperatorSeesConditionAndDelayAndThatTheDeviceDelayIsEstimated()
        {
            Begin(1);
            participant.Until(() => study.Marker.IsMoving);
            for (int frame = 0; frame < 30; ++frame)
            {
                participant.Frame();
            }
            string text = string.Join("\n", study.View.Lines);
            Assert.That(text, Does.Contain("trial 1 of 26 (practice)").And
                .Contain("turn-on, 50 ms in all = system 26.4 ms").And.Contain("pen moves; from pose to block").And.Contain("artificial 23.6").And.Contain("device delay ESTIMATED").And.Contain("level "));
        }

        [Test]
        public void TheStudyRunsWithMouseAndKeyboard()
        {
            Begin(1);
            StudySession session = study.Session!;
            SimulatedInput.Reset();
            for (int frame = 0; frame < 900 && session.Phase == StudyPhase.Task; ++frame)
            {
                PointAt(study.Marker.transform.position);
                SimulatedInput.MouseButton = true;
                World.Frame();
            }
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Question), study.Panel.text);
            SimulatedInput.SetControl("<Keyboard>/y", 1f);
            World.Frame();
            Assert.That(Field(Rows()[0], "answer"), Is.EqualTo("yes"));
        }

        [Test]
        public void TheSettingsAssetContainsEveryFieldWithItsDefault()
        {
            string[] lines = File.ReadAllLines(SampleFiles.In("LatencyStudy", "LatencyStudySettings.asset"));
            object fresh = ScriptableObject.CreateInstance<LatencyStudySettings>();
            FieldInfo[] fields = FieldsOf<LatencyStudySettings>().Concat(FieldsOf<StudySettings>()).ToArray();
            Assert.That(fields, Has.Length.GreaterThan(12));
            foreach (FieldInfo field in fields)
            {
                string key = $"  {field.Name}:";
                int line = Array.FindIndex(lines, each => each.StartsWith(key, StringComparison.Ordinal));
                Assert.That(line, Is.GreaterThan(0), field.Name);
                string expected = field.GetValue(fresh) switch
                {
                    double[] levels => string.Join(" ", levels),
                    Enum choice => Convert.ToInt32(choice).ToString(CultureInfo.InvariantCulture),
                    bool truth => truth ? "1" : "0",
                    object value => Convert.ToString(value, CultureInfo.InvariantCulture)!,
                    null => "",
                };
                string found = lines[line].Substring(field.Name.Length + 3).Trim();
                for (int next = line + 1; next < lines.Length && lines[next].StartsWith("  - "); ++next)
                {
                    found += (found.Length > 0 ? " " : "") + lines[next].Substring(4);
                }
                Assert.That(found, Is.EqualTo(expected), field.Name);
            }
        }

        [Test]
        public void AFallingFrameRatePausesTheStudyUntilTheLevelIsReachableAgain()
        {
            Begin(1);
            StudySession session = study.Session!;
            participant.Until(() => Rows().Length == 1);
            World.FrameRateHz = 22.0;
            participant.Until(() => study.View.Problem != null, 120.0);
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Paused));
            Assert.That(study.View.Problem, Does.Contain("cannot be reached"));
            int answered = Rows().Length;
            World.FrameRateHz = 90.0;
            participant.Until(() => study.View.Problem == null);
            participant.Until(() => Rows().Length == answered + 1);
        }

        [Test]
        public void APenThatDoesNotFollowTheMarkerRepeatsTheTrial()
        {
            Begin(1);
            participant.Follows = false;
            participant.Until(() => study.Panel.text.Contains("Stay on the surface"));
            Assert.That(study.Session!.Phase, Is.EqualTo(StudyPhase.Task));
            participant.Follows = true;
            participant.Until(() => Rows().Length == 1);
            Assert.That(Field(Rows()[0], "attempt"), Is.EqualTo("1"));
        }

        [Test]
        public void PausingTheApplicationRestartsTheTrial()
        {
            Begin(1);
            participant.Until(() => study.Marker.IsMoving);
            study.SendMessage("OnApplicationPause", true);
            Assert.That(study.Session!.Phase, Is.EqualTo(StudyPhase.Paused));
            Assert.That(study.Panel.text, Does.Contain("rest"));
            participant.Until(() => Rows().Length == 1);
            Assert.That(Field(Rows()[0], "attempt"), Is.EqualTo("2"));
        }

        [Test]
        public void AStopShorterThanTheLongestDelayIsRefused()
        {
            settings.restSeconds = 0.4f;
            Press(1);
            Assert.That(study.View.Problem, Does.Contain("rest_seconds is 0.4").And.Contain("at least 0.45"));
        }

        [Test]
        public void TheMarkerMovesAt150MillimetresASecondAndStopsAsOftenAsItMoves()
        {
            Marker marker = study.Marker;
            double last = 0.0;
            var fastest = 0.0;
            for (int step = 1; step <= 3000; ++step)
            {
                double way = marker.DistanceAt(0.001 * step, out bool moves, out _);
                double speed = 1000.0 * (way - last);
                Assert.That(speed, Is.EqualTo(0.15).Within(1e-6).Or.EqualTo(0.0).Within(1e-6).Or.InRange(0.0, 0.15),
                    $"{step} ms");
                fastest = Math.Max(fastest, speed);
                last = way;
            }
            Assert.That(fastest, Is.EqualTo(0.15).Within(1e-6));
            Assert.That(last, Is.EqualTo(0.15).Within(1e-6), "two strokes of half a second");
            marker.DistanceAt(2.49, out _, out bool isDoneEarly);
            marker.DistanceAt(2.51, out _, out bool isDone);
            Assert.That((isDoneEarly, isDone), Is.EqualTo((false, true)));
        }

        private void OpenScene()
        {
            FinishLoading();
            study = Open<LatencyStudyScene>("LatencyStudy", scene =>
            {
                ListenAtTheCamera();
                scene.Settings = settings;
            }).Study;
            participant = new LatencyParticipant(study);
            pen = RightPen();
            PlayFor(1.0);
        }

        private void Press(int number) => study.View.Begin!(number);

        /// <summary>Begins the study as the operator, and continues after every rest.</summary>
        private void Begin(int number)
        {
            Press(number);
            Assert.That(study.View.Problem, Is.Null);
            study.gameObject.AddComponent<PatientOperator>().Study = study;
            World.Frame();
        }

        private string Csv() => Directory.GetFiles(folder, "*.csv").Single();

        private string[] Rows() => Directory.Exists(folder)
            ? File.ReadAllText(Csv()).Split('\n').Skip(1).Where(row => row.Length > 0).ToArray()
            : Array.Empty<string>();

        private static string Field(string row, string column) => StudyFolder.Field(row, column);

        private static double Number(string row, string column) =>
            double.Parse(Field(row, column), CultureInfo.InvariantCulture);

        /// <summary>Presses Next whenever the study waits for it without a problem.</summary>
        private sealed class PatientOperator : MonoBehaviour
        {
            public LatencyStudy Study { get; set; } = null!;

            private void Update()
            {
                if (Study.View.Problem == null)
                {
                    Study.Session!.Continue();
                }
            }
        }
    }
}
