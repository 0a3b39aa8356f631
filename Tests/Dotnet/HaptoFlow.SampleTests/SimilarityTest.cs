using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Threading.Tasks;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Studies;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>A test of the similarity study with a simulated participant, who holds the pen in the right hand and
    /// answers with the left one.</summary>
    public abstract class SimilarityTest : SampleTest
    {
        private const double HandMps = 0.6;
        private const float InsetMetres = 0.003f;
        private const float DeepMetres = 0.001f;

        private static readonly string[] Labels = { "wood", "jute", "ceramic", "plastic", "fur", "metal" };

        private protected SimilarityStudyScene scene = null!;
        private protected Dictionary<string, double> inference = new Dictionary<string, double>();
        private protected Func<StudyMethod, HapticLoadedModel, Task<double>>? measure;
        private Vector3 tip;

        private protected string Csv => Directory.GetFiles(folder, "*.csv").Single();

        private protected SimilarityProcedure Procedure => scene.Procedure!;

        [SetUp]
        public void SetInferenceTimes()
        {
            inference = new Dictionary<string, double>();
            measure = (method, _) => Task.FromResult(
                inference.TryGetValue(method.name, out double milliseconds) ? milliseconds : 6.0);
        }

        /// <summary>Creates settings with up to six labels and up to four methods, which are two tiers of two models.
        /// </summary>
        private protected SimilarityStudySettings Settings(int materials, int methods) => Settings(
            Labels.Take(materials).Select(label => new StudyMaterial { name = "Sample of " + label, label = label }),
            new[]
            {
                Method("Ours quick", Named(DefaultModel.Asset(), "ours"), HapticQuality.Draft),
                Method("Rival quick", Named(EditedModel.WithLabelsReversed(), "rival"), HapticQuality.Draft),
                Method("Ours", Named(DefaultModel.Asset(), "ours"), HapticQuality.Standard),
                Method("Rival", Named(EditedModel.WithLabelsReversed(), "rival"), HapticQuality.Standard),
            }.Take(methods));

        private protected static StudyMethod Method(string name, HapticModelAsset? model, HapticQuality quality) =>
            new StudyMethod { name = name, model = model, quality = quality };

        private protected SimilarityStudySettings Settings(
            IEnumerable<StudyMaterial> materials, IEnumerable<StudyMethod> methods)
        {
            var settings = ScriptableObject.CreateInstance<SimilarityStudySettings>();
            settings.name = "Test Study";
            settings.materials = materials.ToArray();
            settings.methods = methods.ToArray();
            settings.Folder = folder;
            settings.Seed = 5;
            settings.needsAlignment = false;
            return settings;
        }

        private protected static HapticModelAsset Named(HapticModelAsset model, string name)
        {
            model.name = name;
            return model;
        }

        private protected void Open(SimilarityStudySettings? settings, string saveName = "")
        {
            scene = Open<SimilarityStudyScene>("SimilarityStudy", bootstrap =>
            {
                ListenAtTheCamera();
                bootstrap.Settings = settings;
                bootstrap.SaveName = saveName;
                bootstrap.MeasureInference = measure ?? bootstrap.MeasureInference;
            });
            Hold(new Vector3(0f, 0.1f, 0f));
        }

        /// <summary>Waits until the models are loaded, or the study has refused to begin.</summary>
        private protected void Prepare() => WaitUntil(() => scene.CanBegin || scene.Problem != null);

        private protected static void WaitUntil(Func<bool> isSo)
        {
            var until = DateTime.UtcNow.AddMinutes(2);
            while (!isSo() && DateTime.UtcNow < until)
            {
                World.Frame();
            }
        }

        private protected void Begin(SimilarityStudySettings settings)
        {
            TryToBegin(settings);
            Assert.That(scene.Problem, Is.Null);
        }

        private protected void TryToBegin(SimilarityStudySettings? settings)
        {
            Open(settings);
            Prepare();
            scene.Begin(7);
        }

        /// <summary>Ends the application without warning. Only what has been written remains.</summary>
        private protected void Crash()
        {
            World.LoadEmptyScene();
            Make("Stepper").AddComponent<EngineStepper>();
        }

        /// <summary>Runs every trial and every pause until the plan is finished.</summary>
        /// <param name="stopAt">The trial in which to stop; 0 for none.</param>
        /// <returns>The pauses that the operator has ended.</returns>
        private protected List<StudyPause> TakePart(int stopAt = 0)
        {
            var pauses = new List<StudyPause>();
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                if (scene.Session.Phase == StudyPhase.Paused)
                {
                    pauses.Add(scene.Session.Pause);
                    scene.Session.Continue();
                    continue;
                }
                PlannedTrial trial = scene.Session.Trial!;
                Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.RealEdges), $"trial {trial.Trial}");
                TraceReal();
                Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.VirtualEdges), $"trial {trial.Trial}");
                if (trial.Trial == stopAt)
                {
                    return pauses;
                }
                TraceVirtual();
                Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.Free), $"trial {trial.Trial}");
                Slide(Corner(scene.Virtual.Frame, 0), scene.Virtual.Frame.position);
                Answer(RatingOf(trial));
            }
            return pauses;
        }

        /// <summary>The answer of the simulated participant, another rating for each pair.</summary>
        private protected static int RatingOf(PlannedTrial trial) => 1 + (trial.Trial * 3 + trial.Method!.Length) % 7;

        private protected void Answer(int rating)
        {
            Press("<Keyboard>/" + rating);
            Press(Left + "triggerPressed");
        }

        private protected void TraceReal() => Trace(scene.Real.Frame, EdgeTracing.EdgeCount);

        private protected void TraceVirtual() => Trace(scene.Virtual.Frame, EdgeTracing.EdgeCount);

        /// <summary>Slides along a number of edges, and lifts off.</summary>
        private protected void Trace(Transform frame, int edges, float heightMetres = -DeepMetres)
        {
            Hold(Corner(frame, 0) + 0.02f * Vector3.up);
            for (int corner = 0; corner <= edges; ++corner)
            {
                MoveTo(Corner(frame, corner % 4) + (scene.Pen.TipRadiusMetres + heightMetres) * Vector3.up);
            }
            Hold(tip + 0.03f * Vector3.up);
        }

        private protected void Slide(Vector3 from, Vector3 to)
        {
            Vector3 down = (scene.Pen.TipRadiusMetres - DeepMetres) * Vector3.up;
            Hold(from + down);
            MoveTo(to + down);
            Hold(to + 0.03f * Vector3.up);
        }

        /// <summary>A point near a corner of an object's top: 0 near left, 1 near right, 2 far right, 3 far left.
        /// </summary>
        private protected Vector3 Corner(Transform frame, int corner)
        {
            Vector3 size = scene.Settings!.sampleMetres;
            float x = (corner == 1 || corner == 2 ? 0.5f : -0.5f) * (size.x - 2f * InsetMetres);
            float z = (corner >= 2 ? 0.5f : -0.5f) * (size.z - 2f * InsetMetres);
            return frame.TransformPoint(new Vector3(x, 0f, z));
        }

        private protected void MoveTo(Vector3 to)
        {
            Vector3 from = tip;
            int frames = Math.Max(1, (int)Math.Ceiling(Vector3.Distance(from, to) / HandMps * World.FrameRateHz));
            for (int frame = 1; frame <= frames; ++frame)
            {
                Hold(from + (to - from) * (frame / (float)frames));
            }
        }

        private protected void Hold(Vector3 place)
        {
            tip = place;
            Track(place);
            World.Frame();
        }

        /// <summary>The largest magnitude on the actuator's channel since <see cref="AudioDevice.Forget"/>.</summary>
        private protected float LoudestFelt() => Loudest(scene.Output.Channel);

        private protected List<Dictionary<string, string>> Rows()
        {
            string[] lines = File.ReadAllText(Csv).TrimEnd('\n').Split('\n');
            string[] columns = lines[0].Split(',');
            return lines.Skip(1).Select(line => line.Split(',').Select((value, place) => (columns[place], value))
                .ToDictionary(each => each.Item1, each => each.value)).ToList();
        }

        private protected static double Number(Dictionary<string, string> row, string column) =>
            double.Parse(row[column], CultureInfo.InvariantCulture);
    }

    internal static class RecordedSession
    {
        /// <summary>If HAPTOFLOW_RECORD_SESSIONS is set, replaces the sessions of the study in
        /// Tests/Golden/studies by the only session of the folder.</summary>
        public static void Keep(string folder, string study)
        {
            if (string.IsNullOrEmpty(Environment.GetEnvironmentVariable("HAPTOFLOW_RECORD_SESSIONS")))
            {
                return;
            }
            string sessions = RepositoryFiles.In("Tests", "Golden", "studies");
            foreach (string old in Directory.GetFiles(sessions, study + "-*"))
            {
                File.Delete(old);
            }
            foreach (string file in Directory.GetFiles(folder))
            {
                File.Copy(file, Path.Combine(sessions, Path.GetFileName(file)));
            }
        }
    }
}
