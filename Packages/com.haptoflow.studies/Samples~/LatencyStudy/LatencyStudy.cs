#nullable enable
using System.Collections.Generic;
using System.Globalization;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>The procedure of the study: refuses delays that the set-up cannot reach, sets each trial's delay, waits
    /// for the pen, runs the marker, asks, and waits until every answer is on disk.</summary>
    [DefaultExecutionOrder(900)]
    public sealed class LatencyStudy : MonoBehaviour
    {
        // The marker starts when the pen has rested this near to it for this long.
        private const float NearMetres = 0.03f;
        private const double SettledSeconds = 0.5;

        // The share of the marker's distance that the pen has to cover, so that the trial counts.
        private const double FollowedShare = 0.5;
        private const double SecondsBetweenChecks = 0.25;

        private readonly List<(HapticStylus Stylus, TrialContact Contact)> pens =
            new List<(HapticStylus, TrialContact)>();

        private readonly PoseInterval poses = new PoseInterval();
        private LatencyStudySettings settings = null!;
        private HapticOutput output = null!;
        private MaskingNoise noise = null!;
        private ButtonPress? yes;
        private ButtonPress? no;
        private TrialContact? tracingContact;
        private TrialRecord? answeredRecord;
        private double nearSinceSeconds = double.NaN;
        private double nextCheckSeconds;

        /// <summary>Null until the operator has chosen the participant.</summary>
        public StudySession? Session { get; private set; }
        public Marker Marker { get; private set; } = null!;
        public TextMesh Panel { get; private set; } = null!;
        public OperatorView View { get; private set; } = null!;

        /// <summary>The delay of the system in the current trial, without the artificial part.</summary>
        public SystemDelay Delay { get; private set; }

        /// <summary>The delay of the system: the current pose interval and audio block, and the device delay of the
        /// settings. Allocates nothing.</summary>
        /// <exception cref="StudyException">The device delay of the settings is negative or not finite.</exception>
        public SystemDelay MeasureDelay() => new SystemDelay(
            poses.MedianMilliseconds, 0.0, StudyPlayer.BlockMilliseconds, settings.DeviceDelayMilliseconds);

        /// <summary>Begins or resumes a participant's session, or shows the operator why it cannot.</summary>
        /// <param name="participant">The number of the participant, from 1.</param>
        public void Begin(int participant)
        {
            try
            {
                CheckIsReady();
                Delay = MeasureDelay();
                Delay.CheckReaches(settings.levelsMilliseconds);
                StudyLog log = StudyLog.Open(settings.Folder, Describe(participant));
                if (Session != null)
                {
                    Session.Changed -= OnChanged;
                }
                Session = new StudySession(log);
                Session.Changed += OnChanged;
                View.Session = Session;
                View.Problem = null;
                Panel.text = "Please wait for the operator.";
            }
            catch (StudyException refusal)
            {
                View.Problem = refusal.Message;
            }
        }

        internal void Prepare(LatencyStudySettings chosen, HapticOutput haptics, MaskingNoise masking, Marker followed,
            TextMesh asking, OperatorView operators)
        {
            settings = chosen;
            output = haptics;
            noise = masking;
            Marker = followed;
            Panel = asking;
            View = operators;
            View.Output = output;
            View.Detail = Detail;
            View.Begin = Begin;
            View.Advice = number => StudyLog.NumbersLeftOut(settings.Folder, StudyKind.Latency, number);
            string controller = ButtonPress.ControllerOppositeTo(settings.penHand);
            yes = new ButtonPress("<Keyboard>/y", controller + "triggerPressed");
            no = new ButtonPress("<Keyboard>/n", controller + "gripPressed");
            output.SetSignal(settings.toneHertz, settings.toneMps2);
            output.Muted = true;
            Panel.text = "Please wait for the operator.";
        }

        internal void AddPen(HapticStylus stylus) => pens.Add((stylus, new TrialContact(stylus)));

        private StudyDescription Describe(int participant)
        {
            StudyPlan plan = StudyPlan.Latency(participant, settings.Seed, settings.levelsMilliseconds);
            return new StudyDescription(plan, settings.Fields(), Delay)
            {
                IsSimulated = settings.Simulated,
                Build = StudyPlayer.Build(),
                Device = settings.Device(),
            };
        }

        private void CheckIsReady()
        {
            settings.Check();
            string? problem = Haptics.Problem ?? noise.Problem;
            if (problem != null)
            {
                throw new StudyException(problem);
            }
            if (!Haptics.IsReady || !poses.IsMeasured)
            {
                throw new StudyException("the model is still being loaded or the frame rate is still being measured; " +
                    "wait a moment and press Begin again");
            }
        }

        private void Update()
        {
            poses.Add(Time.unscaledDeltaTime);
            bool? answer = ButtonPress.Answer(yes!, no!);
            if (Session == null)
            {
                return;
            }
            Session.Advance(Time.realtimeSinceStartupAsDouble);
            CheckAgainWhileStopped();
            if (Session.Phase == StudyPhase.Task)
            {
                Trace(Session);
            }
            else if (Session.Phase == StudyPhase.Question && answer.HasValue)
            {
                Session.Answer(answeredRecord!.Set("answer", answer.Value ? "yes" : "no"));
            }
        }

        private void OnApplicationPause(bool paused)
        {
            if (paused)
            {
                Session?.PauseHere();
            }
        }

        private void OnDestroy()
        {
            yes?.Dispose();
            no?.Dispose();
            pens.ForEach(pen => pen.Contact.Dispose());
        }

        private void OnChanged(StudySession changed)
        {
            output.Muted = true;
            switch (changed.Phase)
            {
                case StudyPhase.Task:
                    BeginTrial(changed);
                    break;
                case StudyPhase.Question:
                    Panel.text = Question(changed.Trial!);
                    break;
                case StudyPhase.Finished:
                    Panel.text = "That was all. Thank you!";
                    break;
                default:
                    Marker.Wait();
                    Panel.text = "Please lift the pen and rest. The operator will continue.";
                    break;
            }
        }

        private void BeginTrial(StudySession begun)
        {
            WaitForThePen();
            Delay = MeasureDelay();
            double planned = begun.Trial!.DelayMilliseconds!.Value;
            if (!TryReach(planned))
            {
                begun.PauseHere();
                return;
            }
            output.Processing.DelayMilliseconds = (float)Delay.ArtificialMilliseconds(planned);
            output.ApplyProcessing();
            Panel.text = Instruction(begun.Trial);
        }

        /// <summary>Checks the delay again: when the frame rate has fallen since the start, the set-up may be too slow
        /// for a level that it reached then.</summary>
        private bool TryReach(double planned)
        {
            try
            {
                Delay.CheckReaches(new[] { planned });
                View.Problem = null;
                return true;
            }
            catch (StudyException refusal)
            {
                View.Problem = refusal.Message;
                return false;
            }
        }

        private void CheckAgainWhileStopped()
        {
            double now = Time.unscaledTimeAsDouble;
            bool isStopped = Session!.Phase == StudyPhase.Paused && View.Problem != null;
            if (isStopped && Session.Trial != null && now >= nextCheckSeconds)
            {
                nextCheckSeconds = now + SecondsBetweenChecks;
                Delay = MeasureDelay();
                TryReach(Session.Trial.DelayMilliseconds!.Value);
            }
        }

        private void Trace(StudySession traced)
        {
            if (tracingContact == null)
            {
                RunWhenThePenRestsAtTheMarker();
            }
            else if (Marker.IsDone)
            {
                double expectedMillimetres = settings.strokes * settings.moveSeconds * settings.markerSpeedMmps;
                bool hasFollowed = tracingContact.Starts > 0 && tracingContact.Stops > 0 &&
                    tracingContact.PathMillimetres >= FollowedShare * expectedMillimetres;
                if (hasFollowed)
                {
                    answeredRecord = RecordOf(traced.Trial!, tracingContact);
                    traced.Ask();
                }
                else
                {
                    WaitForThePen();
                    Panel.text = Instruction(traced.Trial!) +
                        "\nStay on the surface, and stop when the marker stops.";
                }
            }
        }

        private void WaitForThePen()
        {
            tracingContact = null;
            nearSinceSeconds = double.NaN;
            output.Muted = true;
            Marker.Wait();
        }

        private void RunWhenThePenRestsAtTheMarker()
        {
            double now = Time.unscaledTimeAsDouble;
            foreach ((HapticStylus stylus, TrialContact contact) in pens)
            {
                bool isNear = stylus.IsTouching &&
                    Vector3.Distance(stylus.Contact.Point, Marker.transform.position) <= NearMetres;
                if (!isNear)
                {
                    continue;
                }
                if (double.IsNaN(nearSinceSeconds))
                {
                    nearSinceSeconds = now;
                }
                if (now - nearSinceSeconds >= SettledSeconds)
                {
                    tracingContact = contact;
                    contact.Begin();
                    Marker.Run();
                    // The output is muted until here, because the participant judges only the marker's strokes.
                    output.Muted = false;
                }
                return;
            }
            nearSinceSeconds = double.NaN;
        }

        private TrialRecord RecordOf(PlannedTrial trial, TrialContact contact) => contact
            .AddTo(new TrialRecord().SetDelay(trial.DelayMilliseconds!.Value, Delay))
            .Set("starts", contact.Starts)
            .Set("stops", contact.Stops);

        private static string Instruction(PlannedTrial trial) => (trial.IsPractice ? "Practice. " : "") +
            (trial.Condition == StudyPlan.TurnOn
                ? "Attend to the moments when you SET OFF."
                : "Attend to the moments when you STOP.") +
            "\nPut the pen on the green marker and follow it.";

        private static string Question(PlannedTrial trial) => (trial.Condition == StudyPlan.TurnOn
                ? "When you SET OFF: did the vibration begin late?"
                : "When you STOPPED: did the vibration stop late?") +
            "\ntrigger (or key Y): yes        grip (or key N): no";

        private string Detail()
        {
            PlannedTrial? trial = Session?.Trial;
            string text = trial == null
                ? $"system delay {MeasureDelay()}"
                : string.Format(CultureInfo.InvariantCulture, "{0}, {1} ms in all = system {2} + artificial {3:0.0}",
                    trial.Condition, trial.DelayMilliseconds, Delay, output.Processing.DelayMilliseconds);
            string source = settings.DeviceDelaySource == DeviceDelaySource.Measured
                ? "measured" : "ESTIMATED, not measured";
            text += $"\ndevice delay {source}: {settings.DeviceDelayNote}";
            foreach ((HapticStylus stylus, TrialContact contact) in pens)
            {
                if (contact == tracingContact && stylus.TryGetSignalStatistics(out SignalStatistics signal))
                {
                    text += string.Format(CultureInfo.InvariantCulture,
                        "\npen {0}; from pose to block, artificial delay included: start {1:0.0} ms, stop {2:0.0} ms",
                        contact.IsMoving ? "moves" : "rests", 1000.0 * signal.LastStartLatencySeconds,
                        1000.0 * signal.LastStopLatencySeconds);
                }
            }
            return text;
        }
    }
}
