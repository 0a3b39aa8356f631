#nullable enable
using HaptoFlow.Studies;
using UnityEngine;

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
}
