#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Studies;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The stage of a trial: what the participant does.</summary>
    public enum TrialStage
    {
        /// <summary>The participant waits: the study is paused or over.</summary>
        Waiting,

        /// <summary>The participant traces the four edges of the real sample; the haptics are muted.</summary>
        RealEdges,

        /// <summary>The participant traces the four edges of the virtual object.</summary>
        VirtualEdges,

        /// <summary>The participant explores both freely; the question is shown.</summary>
        Free,
    }

    /// <summary>Runs the stages of each trial: sets model, material and delay, mutes the haptics on the real sample,
    /// shows the question, and passes the answer to the session. Main thread.</summary>
    /// <remarks>Runs after <see cref="HapticStylus"/>, so that it sees the contact of the same frame.</remarks>
    [DefaultExecutionOrder(1200)]
    public sealed class SimilarityProcedure : MonoBehaviour
    {
        private StudySession session = null!;
        private TrialParts parts = null!;
        private HapticStylus pen = null!;
        private TrialContact contact = null!;
        private double stageSeconds;
        private double realSeconds;
        private double virtualSeconds;
        private bool isTrialNew;

        /// <summary>The current stage.</summary>
        public TrialStage Stage { get; private set; }

        /// <summary>Creates the procedure for a session, from its first pause to its end.</summary>
        public static SimilarityProcedure Create(StudySession session, TrialParts parts)
        {
            var procedure = new GameObject("Procedure").AddComponent<SimilarityProcedure>();
            procedure.session = session;
            procedure.parts = parts;
            procedure.Observe(parts.Pen);
            session.Changed += procedure.OnChanged;
            parts.Panel.Confirmed += procedure.OnConfirmed;
            procedure.OnChanged(session);
            return procedure;
        }

        private void Update() => session.Advance(Time.realtimeSinceStartupAsDouble);

        private void LateUpdate()
        {
            if (isTrialNew)
            {
                // Not earlier: the pen gets a voice of the trial's model in the frame after the model is set.
                isTrialNew = false;
                contact.Begin();
            }
            if (Stage == TrialStage.RealEdges)
            {
                parts.Real.Trace(pen);
                if (parts.Real.Tracing.IsComplete)
                {
                    realSeconds = session.ElapsedSeconds - stageSeconds;
                    Enter(TrialStage.VirtualEdges);
                }
            }
            else if (Stage == TrialStage.VirtualEdges)
            {
                parts.Virtual.Trace(pen);
                if (parts.Virtual.Tracing.IsComplete)
                {
                    virtualSeconds = session.ElapsedSeconds - stageSeconds;
                    session.Ask();
                }
            }
            parts.Real.ShowEdges(Stage == TrialStage.RealEdges);
            parts.Virtual.ShowEdges(Stage == TrialStage.VirtualEdges);
        }

        private void OnDestroy()
        {
            session.Changed -= OnChanged;
            parts.Panel.Confirmed -= OnConfirmed;
            contact.Dispose();
        }

        private void OnChanged(StudySession changed)
        {
            switch (changed.Phase)
            {
                case StudyPhase.Task:
                    Begin(changed.Trial!);
                    break;
                case StudyPhase.Question:
                    Enter(TrialStage.Free);
                    parts.Panel.Open();
                    break;
                default:
                    parts.Panel.Close();
                    Enter(TrialStage.Waiting);
                    break;
            }
        }

        private void Begin(PlannedTrial trial)
        {
            parts.Panel.Close();
            if (!ReferenceEquals(pen, parts.Pen))
            {
                contact.Dispose();
                Observe(parts.Pen);
            }
            parts.Play(trial);
            parts.Real.Tracing.Begin();
            parts.Virtual.Tracing.Begin();
            isTrialNew = true;
            Enter(TrialStage.RealEdges);
        }

        private void Observe(HapticStylus used)
        {
            pen = used;
            contact = new TrialContact(used, parts.Virtual.Surface);
        }

        private void Enter(TrialStage stage)
        {
            Stage = stage;
            stageSeconds = session.ElapsedSeconds;
            // On the real sample, the participant feels the real vibration.
            parts.Output.Muted = stage != TrialStage.VirtualEdges && stage != TrialStage.Free;
            parts.Instruction.text = stage switch
            {
                TrialStage.RealEdges => "Slide along the four edges of the LEFT object.",
                TrialStage.VirtualEdges => "Now slide along the four edges of the RIGHT object.",
                TrialStage.Free => "Feel both objects for as long as you like, then answer.",
                _ => WhileWaiting(),
            };
        }

        private string WhileWaiting()
        {
            if (session.Phase == StudyPhase.Finished)
            {
                return "The study is over. Thank you.";
            }
            return session.Phase == StudyPhase.Paused && session.Pause == StudyPause.Rest
                ? "Please rest. Say when you are ready to go on."
                : "Please wait until the study continues, and keep the pen off the objects.";
        }

        private void OnConfirmed(int rating)
        {
            PlannedTrial trial = session.Trial!;
            var record = new TrialRecord()
                .SetDelay(parts.Delay.Milliseconds, parts.Delay.Of(trial.Method!))
                .Set("real_edges_seconds", realSeconds)
                .Set("virtual_edges_seconds", virtualSeconds)
                .Set("free_seconds", session.ElapsedSeconds - stageSeconds)
                .Set("rating", rating);
            session.Answer(contact.AddTo(record));
        }
    }

    /// <summary>The parts of a trial: two objects that look the same, a pen, an output, the models of the methods, the
    /// materials, and one delay for all methods. Main thread.</summary>
    public sealed class TrialParts : IDisposable
    {
        private readonly MethodModels models;
        private readonly XrRig rig;
        private readonly Dictionary<string, HapticMaterial> materials;
        private readonly List<HapticMaterial> created = new List<HapticMaterial>();

        /// <param name="settings">The settings with the materials.</param>
        /// <param name="models">The models of the methods, loaded and measured.</param>
        public TrialParts(SimilarityStudySettings settings, MethodModels models, EqualDelay delay, StudyObject real,
            StudyObject @virtual, XrRig rig, HapticOutput output, RatingPanel panel, TextMesh instruction)
        {
            this.models = models;
            Delay = delay;
            Real = real;
            Virtual = @virtual;
            this.rig = rig;
            Output = output;
            Panel = panel;
            Instruction = instruction;
            materials = settings.Materials.ToDictionary(each => each.Name, MaterialOf, StringComparer.Ordinal);
        }

        /// <summary>The delay that all methods get.</summary>
        public EqualDelay Delay { get; }

        /// <summary>The object in the place of the real sample, without haptics.</summary>
        public StudyObject Real { get; }

        /// <summary>The virtual object beside it.</summary>
        public StudyObject Virtual { get; }

        /// <summary>The tracked pen; before it was tracked for the first time, the mouse pen.</summary>
        public HapticStylus Pen => rig.PenInUse!;

        /// <summary>The output that drives the actuator.</summary>
        public HapticOutput Output { get; }

        /// <summary>The question and its answers.</summary>
        public RatingPanel Panel { get; }

        /// <summary>The text that the participant reads.</summary>
        public TextMesh Instruction { get; }

        /// <summary>Sets the virtual object to the trial's material, generated by the trial's method with the delay
        /// that all methods get. It takes effect in the next frame.</summary>
        public void Play(PlannedTrial trial)
        {
            models.Use(trial.Method!);
            Virtual.Surface.SharedMaterial = materials[trial.Material!];
            Output.Processing.DelayMilliseconds = (float)Delay.ArtificialMilliseconds(trial.Method!);
            Output.ApplyProcessing();
        }

        /// <summary>Destroys the materials that this object created.</summary>
        public void Dispose()
        {
            created.ForEach(Object.Destroy);
            created.Clear();
        }

        private HapticMaterial MaterialOf(StudyMaterial material)
        {
            if (material.Material != null)
            {
                return material.Material;
            }
            var texture = ScriptableObject.CreateInstance<HapticMaterial>();
            texture.Description.Label = material.Label;
            texture.Description.Effects = HapticEffects.Texture;
            created.Add(texture);
            return texture;
        }
    }

    /// <summary>Gives all methods the delay of the slowest, by adding an artificial delay to the others.</summary>
    public sealed class EqualDelay
    {
        /// <summary>The reserve above the delay of the slowest method. With it, a session that is resumed after an
        /// interruption, and measured again, can get the same delay.</summary>
        public const double ReserveMilliseconds = 2.0;

        private readonly Dictionary<string, SystemDelay> delays;

        /// <param name="delays">The delay of the system with each method.</param>
        /// <param name="milliseconds">The delay that every method shall have; null for that of the slowest method plus
        /// <see cref="ReserveMilliseconds"/>.</param>
        /// <exception cref="StudyException">A method is too slow or too fast; the message names it.</exception>
        public EqualDelay(IReadOnlyDictionary<string, SystemDelay> delays, double? milliseconds)
        {
            this.delays = delays.ToDictionary(each => each.Key, each => each.Value, StringComparer.Ordinal);
            Slowest = delays.OrderByDescending(each => each.Value.TotalMilliseconds).First().Key;
            Milliseconds = milliseconds ??
                Math.Ceiling(delays[Slowest].TotalMilliseconds + ReserveMilliseconds);
            foreach (KeyValuePair<string, SystemDelay> each in delays)
            {
                if (!each.Value.Reaches(Milliseconds))
                {
                    throw new StudyException(FormattableString.Invariant(
                        $"method \"{each.Key}\" cannot have a delay of {Milliseconds:0.###} ms: its system delay is ") +
                        each.Value + FormattableString.Invariant(
                        $", and at most {SystemDelay.MaximumArtificialMilliseconds:0} ms can be added; ") +
                        "close other programs, or change Equal Delay Milliseconds before the first participant");
                }
            }
        }

        /// <summary>The total delay of every method.</summary>
        public double Milliseconds { get; }

        /// <summary>The method with the longest delay of the system.</summary>
        public string Slowest { get; }

        /// <summary>The delay of the system with a method, without the artificial part.</summary>
        public SystemDelay Of(string method) => delays[method];

        /// <summary>The artificial delay that the output has to add for a method.</summary>
        public double ArtificialMilliseconds(string method) => delays[method].ArtificialMilliseconds(Milliseconds);

        /// <summary>The delay of an interrupted session, read from its log; null without such a session.</summary>
        /// <param name="folder">The folder of the logs.</param>
        /// <exception cref="StudyException">A log exists and cannot be read.</exception>
        public static double? OfInterrupted(string folder, int participant)
        {
            try
            {
                return Directory.Exists(folder)
                    ? Directory.GetFiles(folder, $"similarity-P{participant:00}-*.csv").Select(DelayOf)
                        .FirstOrDefault(each => each != null)
                    : null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                throw new StudyException($"{folder}: {error.Message}; close the program that holds the file", error);
            }
        }

        /// <summary>The delay in a log's first complete row.</summary>
        private static double? DelayOf(string path)
        {
            string[] lines = File.ReadAllText(path).Split('\n');
            // The last line is empty, or incomplete after a crash.
            if (lines.Length <= 2)
            {
                return null;
            }
            int column = Array.IndexOf(lines[0].Split(','), "delay_ms");
            string[] fields = lines[1].Split(',');
            bool hasDelay = column >= 0 && column < fields.Length;
            return hasDelay && double.TryParse(
                fields[column], NumberStyles.Float, CultureInfo.InvariantCulture, out double milliseconds)
                ? milliseconds
                : (double?)null;
        }
    }
}
