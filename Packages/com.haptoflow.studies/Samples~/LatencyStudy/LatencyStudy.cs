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

        /// <summary>The marker that the pen has to follow.</summary>
        public Marker Marker { get; private set; } = null!;

        /// <summary>The panel that the participant reads.</summary>
        public QuestionPanel Panel { get; private set; } = null!;

        /// <summary>The view that the operator sees.</summary>
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
                Delay.CheckReaches(settings.LevelsMilliseconds);
                StudyLog log = StudyLog.Open(settings.Folder, Describe(participant));
                if (Session != null)
                {
                    Session.Changed -= OnChanged;
                }
                Session = new StudySession(log);
                Session.Changed += OnChanged;
                View.Session = Session;
                View.Problem = null;
                Panel.Welcome();
            }
            catch (StudyException refusal)
            {
                View.Problem = refusal.Message;
            }
        }

        internal void Prepare(LatencyStudySettings chosen, HapticOutput haptics, MaskingNoise masking, Marker followed,
            QuestionPanel asking, OperatorView operators)
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
            string controller = ButtonPress.ControllerOppositeTo(settings.PenHand);
            yes = new ButtonPress("<Keyboard>/y", controller + "triggerPressed");
            no = new ButtonPress("<Keyboard>/n", controller + "gripPressed");
            output.SetSignal(settings.ToneHertz, settings.ToneMps2);
            output.Muted = true;
            Panel.Welcome();
        }

        internal void AddPen(HapticStylus stylus) => pens.Add((stylus, new TrialContact(stylus)));

        private StudyDescription Describe(int participant)
        {
            StudyPlan plan = StudyPlan.Latency(participant, settings.Seed, settings.LevelsMilliseconds);
            return new StudyDescription(plan, settings.Fields(), Delay)
            {
                IsSimulated = settings.Simulated,
                Environment = settings.Environment(),
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
                    Panel.Ask(changed.Trial!);
                    break;
                case StudyPhase.Finished:
                    Panel.Thank();
                    break;
                default:
                    Marker.Wait();
                    Panel.Rest();
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
            Panel.Instruct(begun.Trial);
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
                double expectedMillimetres = settings.Strokes * settings.MoveSeconds * settings.MarkerSpeedMmps;
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
                    Panel.AskToFollow(traced.Trial!);
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
