#nullable enable
using System;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>What the participant does in a trial.</summary>
    public enum TrialStage
    {
        /// <summary>Nothing: the study is paused, at rest or over.</summary>
        Waiting,

        /// <summary>The four edges of the real sample; the haptics are muted.</summary>
        RealEdges,

        /// <summary>The four edges of the virtual object.</summary>
        VirtualEdges,

        /// <summary>Both, freely; the question is open.</summary>
        Free,
    }

    /// <summary>Leads through the stages of each trial: chooses its model, material and delay, mutes the haptics on the
    /// real sample, asks, and hands the answer to the session. Main thread.</summary>
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
        private bool isNew;

        /// <summary>What the participant does now.</summary>
        public TrialStage Stage { get; private set; }

        /// <summary>Follows a session from its first pause to its end.</summary>
        public static SimilarityProcedure Create(StudySession session, TrialParts parts)
        {
            var procedure = new GameObject("Procedure").AddComponent<SimilarityProcedure>();
            procedure.session = session;
            procedure.parts = parts;
            procedure.Count(parts.Pen);
            session.Changed += procedure.OnChanged;
            parts.Panel.Confirmed += procedure.OnConfirmed;
            procedure.OnChanged(session);
            return procedure;
        }

        private void Update() => session.Advance(Time.realtimeSinceStartupAsDouble);

        // After the stylus has looked at its tip.
        private void LateUpdate()
        {
            if (isNew)
            {
                // The pen has a voice of the trial's model by now.
                isNew = false;
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
                Count(parts.Pen);
            }
            parts.Play(trial);
            parts.Real.Tracing.Begin();
            parts.Virtual.Tracing.Begin();
            isNew = true;
            Enter(TrialStage.RealEdges);
        }

        private void Count(HapticStylus used)
        {
            pen = used;
            contact = new TrialContact(used, parts.Virtual.Surface);
        }

        private void Enter(TrialStage stage)
        {
            Stage = stage;
            stageSeconds = session.ElapsedSeconds;
            // The real sample gives the vibration itself.
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
                : "Please wait until it goes on, and keep the pen off the objects.";
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
