#nullable enable
using System;
using System.Collections.Generic;
using System.Text;
using UnityEngine;

namespace HaptoFlow.Studies
{
    /// <summary>The operator's view of a study: progress, level, state of the disk, and buttons. Drawn with Unity's
    /// immediate mode, which appears on screens but not in headsets. Main thread.</summary>
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "operator-view")]
    public sealed class OperatorView : MonoBehaviour
    {
        // New text makes garbage, and faster updates cannot be read.
        private const double SecondsBetween = 0.25;
        private const int MeterSteps = 20;
        private const float LineHeight = 22f;
        private const float Width = 620f;
        private const float Margin = 10f;
        private const float ButtonWidth = 80f;
        private const int MaximumParticipant = 999;

        private static readonly (string Caption, int Step)[] Steps =
        {
            ("-10", -10), ("-1", -1), ("+1", 1), ("+10", 10),
        };

        private readonly List<string> lines = new List<string>();
        private double nextSeconds;
        private int advisedParticipant;
        private string advice = "";

        /// <summary>The session to show; null until there is one.</summary>
        public StudySession? Session { get; set; }

        /// <summary>Number of the next participant, 1 to 999: chosen with buttons while no session is under
        /// way.</summary>
        public int Participant { get; set; } = 1;

        /// <summary>Starts the study for a participant; null where that is done elsewhere.</summary>
        public Action<int>? Begin { get; set; }

        /// <summary>What the operator should know before this number is begun, empty where there is nothing; null
        /// without such advice. Called when the view appears and when the number changes.</summary>
        public Func<int, string>? Advice { get; set; }

        /// <summary>The output whose level the meter shows.</summary>
        public HapticOutput? Output { get; set; }

        /// <summary>Additional lines of the study: condition, delay, what the participant does. Called several times a
        /// second.</summary>
        public Func<string>? Detail { get; set; }

        /// <summary>Why the study cannot continue; null without an error.</summary>
        public string? Problem { get; set; }

        /// <summary>The lines on display.</summary>
        public IReadOnlyList<string> Lines => lines;

        private void Update()
        {
            double now = Time.unscaledTimeAsDouble;
            if (now >= nextSeconds || now < nextSeconds - SecondsBetween)
            {
                nextSeconds = now + SecondsBetween;
                Write();
            }
        }

        private void OnGUI()
        {
            float top = Margin;
            foreach (string line in lines)
            {
                GUI.Label(new Rect(Margin, top, Width, LineHeight), line);
                top += LineHeight;
            }
            if (Session == null || Session.Phase == StudyPhase.Finished)
            {
                DrawChoice(top);
            }
            else if (Session.Phase == StudyPhase.Paused && Problem == null)
            {
                if (Button(0, top, "Next"))
                {
                    Session.Continue();
                }
            }
            else if (Session.Phase == StudyPhase.Task || Session.Phase == StudyPhase.Question)
            {
                if (Button(0, top, "Pause"))
                {
                    Session.PauseHere();
                }
            }
        }

        private void DrawChoice(float top)
        {
            if (Begin == null)
            {
                return;
            }
            int place = 0;
            foreach ((string caption, int step) in Steps)
            {
                if (Button(place++, top, caption))
                {
                    Participant = Math.Max(1, Math.Min(MaximumParticipant, Participant + step));
                    Write();
                }
            }
            if (Button(place, top, "Begin"))
            {
                Begin(Participant);
                Write();
            }
        }

        private static bool Button(int place, float top, string caption) => GUI.Button(
            new Rect(Margin + place * (ButtonWidth + Margin), top, ButtonWidth, 1.5f * LineHeight), caption);

        private void Write()
        {
            lines.Clear();
            if (Session != null && Session.Phase != StudyPhase.Finished)
            {
                // The session adds a log: the next choice is advised anew.
                advisedParticipant = 0;
            }
            if (Session != null)
            {
                lines.Add($"participant P{Session.Plan.Participant:00}, study {Session.Plan.Kind.Name}, " +
                    WhereOf(Session));
                lines.Add(StateOf(Session));
            }
            if (Session == null || Session.Phase == StudyPhase.Finished)
            {
                lines.Add($"participant P{Participant:00}: choose the number and press Begin");
                AddAdvice();
            }
            if (Detail != null)
            {
                lines.AddRange(Detail().Split('\n'));
            }
            if (Output != null)
            {
                lines.Add("level " + Meter(Output.Level));
            }
            if (Session != null)
            {
                lines.Add("disk: " + (Session.Problem == null
                    ? "every answer is saved"
                    : "NOT SAVED, trying again: " + Session.Problem));
            }
            if (Problem != null)
            {
                lines.Add("STOPPED: " + Problem);
            }
        }

        private void AddAdvice()
        {
            // Reading a folder several times a second would make garbage for nothing.
            if (Advice != null && advisedParticipant != Participant)
            {
                advice = Advice(Participant);
                advisedParticipant = Participant;
            }
            if (advice.Length > 0)
            {
                lines.Add("NOTE: " + advice);
            }
        }

        private static string WhereOf(StudySession session)
        {
            PlannedTrial? trial = session.Trial;
            if (trial == null)
            {
                return "all trials are answered";
            }
            string attempt = session.Attempt > 1 ? $", attempt {session.Attempt}" : "";
            return $"trial {trial.Trial} of {session.Plan.Trials.Count} ({trial.Block}){attempt}";
        }

        private static string StateOf(StudySession session) => session.Phase switch
        {
            StudyPhase.Paused => session.Pause switch
            {
                StudyPause.Rest => "rest: press Next when the participant is ready",
                StudyPause.Sample => "another sample: mount it, then press Next",
                StudyPause.Operator => "paused: Next restarts the trial",
                StudyPause.ClockJump => "paused: the application stood still; Next restarts the trial",
                StudyPause.Disk => "paused: the disk works again; press Next",
                _ => "press Next to begin",
            },
            StudyPhase.Task => "the participant does the task",
            StudyPhase.Question => "the participant answers",
            StudyPhase.Disk => "waiting for the disk",
            _ => "finished",
        };

        private static string Meter(float level)
        {
            var text = new StringBuilder(MeterSteps + 8);
            int lit = (int)Math.Round(MeterSteps * Math.Min(1f, level));
            text.Append('|', lit).Append('.', MeterSteps - lit);
            return text.Append(FormattableString.Invariant($" {level:0.00}")).ToString();
        }
    }
}
