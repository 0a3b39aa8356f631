#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Leads through the study: refuses levels out of reach, sets each trial's delay, waits for the pen, runs
    /// the marker, asks, and has every answer written before it goes on.</summary>
    [DefaultExecutionOrder(900)]
    public sealed class LatencyStudy : MonoBehaviour
    {
        private const float NearMetres = 0.03f;
        private const double SettledSeconds = 0.5;
        private const int FramesToMeasure = 64;
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
        private AnswerButtons answers = null!;
        private StudySession? session;
        private TrialContact? tracing;
        private TrialRecord? asked;
        private SystemDelay delay;
        private double nearSinceSeconds = double.NaN;
        private double nextCheckSeconds;

        /// <summary>Null until the operator has chosen the participant.</summary>
        public StudySession? Session => session;

        /// <summary>The marker that the pen follows.</summary>
        public Marker Marker => marker;

        /// <summary>What the participant reads.</summary>
        public QuestionPanel Panel => panel;

        /// <summary>What the operator sees.</summary>
        public OperatorView View => view;

        /// <summary>The present trial's delay without the artificial part.</summary>
        public SystemDelay Delay => delay;

        /// <summary>The system delay from the pose interval and the audio block as they are now, and the device delay of
        /// the settings. Allocates nothing.</summary>
        /// <exception cref="StudyException">The device delay of the settings is no time.</exception>
        public SystemDelay MeasureDelay() => new SystemDelay(
            poses.MedianMilliseconds, 0.0, StudyPlayer.BlockMilliseconds, settings.DeviceDelayMilliseconds);

        /// <summary>Begins or resumes a participant's session, or tells the operator why not.</summary>
        /// <param name="participant">From 1.</param>
        public void Begin(int participant)
        {
            try
            {
                Refuse();
                delay = MeasureDelay();
                delay.CheckReaches(settings.LevelsMilliseconds);
                string folder = settings.Folder.Length > 0 ? settings.Folder : StudyPlayer.DefaultFolder;
                StudyLog log = StudyLog.Open(folder, Describe(participant));
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
            answers = new AnswerButtons(settings.PenHand);
            output.SetSignal(settings.ToneHertz, settings.ToneMps2);
            output.Muted = true;
            panel.Welcome();
        }

        internal void AddPen(HapticStylus stylus) => pens.Add((stylus, new TrialContact(stylus)));

        private StudyDescription Describe(int participant)
        {
            StudyPlan plan = StudyPlan.Latency(participant, settings.Seed, settings.LevelsMilliseconds);
            StudyEnvironment environment = StudyPlayer.Environment(settings.Headset);
            environment.DeviceDelaySource = settings.DeviceDelaySource;
            environment.DeviceDelayNote = settings.DeviceDelayNote;
            return new StudyDescription(plan, settings.Fields(), delay)
            {
                IsSimulated = settings.Simulated,
                Environment = environment,
            };
        }

        private void Refuse()
        {
            settings.Check();
            string? problem = Haptics.Problem ?? noise.Problem;
            if (problem != null)
            {
                throw new StudyException(problem);
            }
            if (!Haptics.IsReady || poses.Count < FramesToMeasure)
            {
                throw new StudyException("the model is being loaded and frames are being measured; press Begin again");
            }
        }

        private void Update()
        {
            poses.Add(Time.unscaledDeltaTime);
            bool? answer = answers.Take();
            if (session == null)
            {
                return;
            }
            session.Advance(Time.realtimeSinceStartupAsDouble);
            CheckAgain();
            if (session.Phase == StudyPhase.Task)
            {
                Trace(session);
            }
            else if (session.Phase == StudyPhase.Question && answer.HasValue)
            {
                session.Answer(asked!.Set("answer", answer.Value ? "yes" : "no"));
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
            answers?.Dispose();
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
            AwaitThePen();
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

        /// <summary>A frame rate that fell may have put a level out of reach that was within it at the start.</summary>
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

        private void CheckAgain()
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
            if (tracing == null)
            {
                RunWhenThePenIsThere();
            }
            else if (marker.IsDone)
            {
                double wanted = settings.Strokes * settings.MoveSeconds * settings.MarkerSpeedMmps;
                bool hasFollowed = tracing.Starts > 0 && tracing.Stops > 0 &&
                    tracing.PathMillimetres >= FollowedShare * wanted;
                if (hasFollowed)
                {
                    asked = RecordOf(traced.Trial!, tracing);
                    traced.Ask();
                }
                else
                {
                    AwaitThePen();
                    panel.AskToFollow(traced.Trial!);
                }
            }
        }

        private void AwaitThePen()
        {
            tracing = null;
            nearSinceSeconds = double.NaN;
            output.Muted = true;
            marker.Wait();
        }

        private void RunWhenThePenIsThere()
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
                    tracing = contact;
                    contact.Begin();
                    marker.Run();
                    // On the way to the marker nothing is felt: the marker's strokes are all that is judged.
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
                if (contact == tracing && stylus.TryGetSignalStatistics(out SignalStatistics signal))
                {
                    text += "\n" + OperatorLines.OfPen(contact, signal);
                }
            }
            return text;
        }
    }
}
