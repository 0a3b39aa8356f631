#nullable enable
using System;
using System.Collections.Generic;
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
        private Marker marker = null!;
        private QuestionPanel panel = null!;
        private OperatorView view = null!;
        private ButtonPress? yes;
        private ButtonPress? no;
        private StudySession? session;
        private TrialContact? tracingContact;
        private TrialRecord? answeredRecord;
        private SystemDelay delay;
        private double nearSinceSeconds = double.NaN;
        private double nextCheckSeconds;

        /// <summary>Null until the operator has chosen the participant.</summary>
        public StudySession? Session => session;

        /// <summary>The marker that the pen has to follow.</summary>
        public Marker Marker => marker;

        /// <summary>The panel that the participant reads.</summary>
        public QuestionPanel Panel => panel;

        /// <summary>The view that the operator sees.</summary>
        public OperatorView View => view;

        /// <summary>The delay of the system in the current trial, without the artificial part.</summary>
        public SystemDelay Delay => delay;

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
                delay = MeasureDelay();
                delay.CheckReaches(settings.LevelsMilliseconds);
                StudyLog log = StudyLog.Open(settings.Folder, Describe(participant));
                if (session != null)
                {
                    session.Changed -= OnChanged;
                }
                session = new StudySession(log);
                session.Changed += OnChanged;
                view.Session = session;
                view.Problem = null;
                panel.Welcome();
            }
            catch (StudyException refusal)
            {
                view.Problem = refusal.Message;
            }
        }

        internal void Prepare(LatencyStudySettings chosen, HapticOutput haptics, MaskingNoise masking, Marker followed,
            QuestionPanel asking, OperatorView operators)
        {
            settings = chosen;
            output = haptics;
            noise = masking;
            marker = followed;
            panel = asking;
            view = operators;
            view.Output = output;
            view.Detail = Detail;
            view.Begin = Begin;
            view.Advice = number => StudyLog.NumbersLeftOut(settings.Folder, StudyKind.Latency, number);
            string controller = ButtonPress.ControllerOppositeTo(settings.PenHand);
            yes = new ButtonPress("<Keyboard>/y", controller + "triggerPressed");
            no = new ButtonPress("<Keyboard>/n", controller + "gripPressed");
            output.SetSignal(settings.ToneHertz, settings.ToneMps2);
            output.Muted = true;
            panel.Welcome();
        }

        internal void AddPen(HapticStylus stylus) => pens.Add((stylus, new TrialContact(stylus)));

        private StudyDescription Describe(int participant)
        {
            StudyPlan plan = StudyPlan.Latency(participant, settings.Seed, settings.LevelsMilliseconds);
            return new StudyDescription(plan, settings.Fields(), delay)
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
            if (session == null)
            {
                return;
            }
            session.Advance(Time.realtimeSinceStartupAsDouble);
            CheckAgainWhileStopped();
            if (session.Phase == StudyPhase.Task)
            {
                Trace(session);
            }
            else if (session.Phase == StudyPhase.Question && answer.HasValue)
            {
                session.Answer(answeredRecord!.Set("answer", answer.Value ? "yes" : "no"));
            }
        }

        private void OnApplicationPause(bool paused)
        {
            if (paused)
            {
                session?.PauseHere();
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
                    panel.Ask(changed.Trial!);
                    break;
                case StudyPhase.Finished:
                    panel.Thank();
                    break;
                default:
                    marker.Wait();
                    panel.Rest();
                    break;
            }
        }

        private void BeginTrial(StudySession begun)
        {
            WaitForThePen();
            delay = MeasureDelay();
            double planned = begun.Trial!.DelayMilliseconds!.Value;
            if (!TryReach(planned))
            {
                begun.PauseHere();
                return;
            }
            output.Processing.DelayMilliseconds = (float)delay.ArtificialMilliseconds(planned);
            output.ApplyProcessing();
            panel.Instruct(begun.Trial);
        }

        /// <summary>Checks the delay again: when the frame rate has fallen since the start, the set-up may be too slow
        /// for a level that it reached then.</summary>
        private bool TryReach(double planned)
        {
            try
            {
                delay.CheckReaches(new[] { planned });
                view.Problem = null;
                return true;
            }
            catch (StudyException refusal)
            {
                view.Problem = refusal.Message;
                return false;
            }
        }

        private void CheckAgainWhileStopped()
        {
            double now = Time.unscaledTimeAsDouble;
            bool isStopped = session!.Phase == StudyPhase.Paused && view.Problem != null;
            if (isStopped && session.Trial != null && now >= nextCheckSeconds)
            {
                nextCheckSeconds = now + SecondsBetweenChecks;
                delay = MeasureDelay();
                TryReach(session.Trial.DelayMilliseconds!.Value);
            }
        }

        private void Trace(StudySession traced)
        {
            if (tracingContact == null)
            {
                RunWhenThePenRestsAtTheMarker();
            }
            else if (marker.IsDone)
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
                    panel.AskToFollow(traced.Trial!);
                }
            }
        }

        private void WaitForThePen()
        {
            tracingContact = null;
            nearSinceSeconds = double.NaN;
            output.Muted = true;
            marker.Wait();
        }

        private void RunWhenThePenRestsAtTheMarker()
        {
            double now = Time.unscaledTimeAsDouble;
            foreach ((HapticStylus stylus, TrialContact contact) in pens)
            {
                bool isNear = stylus.IsTouching &&
                    Vector3.Distance(stylus.Contact.Point, marker.transform.position) <= NearMetres;
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
                    marker.Run();
                    // The output is muted until here, because the participant judges only the marker's strokes.
                    output.Muted = false;
                }
                return;
            }
            nearSinceSeconds = double.NaN;
        }

        private TrialRecord RecordOf(PlannedTrial trial, TrialContact contact) => contact
            .AddTo(new TrialRecord().SetDelay(trial.DelayMilliseconds!.Value, delay))
            .Set("starts", contact.Starts)
            .Set("stops", contact.Stops);

        private string Detail()
        {
            PlannedTrial? trial = session?.Trial;
            string text = trial == null
                ? $"system delay {MeasureDelay()}"
                : OperatorLines.OfTrial(trial, delay, output.Processing.DelayMilliseconds);
            text += "\n" + OperatorLines.OfDevice(settings);
            foreach ((HapticStylus stylus, TrialContact contact) in pens)
            {
                if (contact == tracingContact && stylus.TryGetSignalStatistics(out SignalStatistics signal))
                {
                    text += "\n" + OperatorLines.OfPen(contact, signal);
                }
            }
            return text;
        }
    }
}
