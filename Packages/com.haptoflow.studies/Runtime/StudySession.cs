#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>State of a session: what it is waiting for.</summary>
    public enum StudyPhase
    {
        /// <summary>Waiting for the operator: <see cref="StudySession.Continue"/>.</summary>
        Paused,

        /// <summary>The participant does the task.</summary>
        Task,

        /// <summary>The participant answers.</summary>
        Question,

        /// <summary>The disk refused a row; writing is tried again.</summary>
        Disk,

        /// <summary>Every trial is answered and written.</summary>
        Finished,
    }

    /// <summary>Why a session is paused.</summary>
    public enum StudyPause
    {
        /// <summary>The session has not started, or not yet resumed after an interruption.</summary>
        Begin,

        /// <summary>The plan has a rest here.</summary>
        Rest,

        /// <summary>The operator mounts another sample.</summary>
        Sample,

        /// <summary>The operator paused the session.</summary>
        Operator,

        /// <summary>The clock stopped or jumped in the middle of a trial.</summary>
        ClockJump,

        /// <summary>The disk refused a row before and works again.</summary>
        Disk,
    }

    /// <summary>Guides one participant through a plan: selects the next trial, times the questions and writes the
    /// answers. A trial during which the session is interrupted starts again as a further attempt. Main
    /// thread.</summary>
    public sealed class StudySession
    {
        private const double SecondsBetweenAttempts = 1.0;

        private readonly StudyLog log;
        private readonly SessionClock clock;
        private double askedSeconds;
        private double nextAttemptSeconds;

        /// <summary>Starts or resumes where the log ends; paused until <see cref="Continue"/>.</summary>
        public StudySession(StudyLog log)
        {
            this.log = log;
            clock = new SessionClock(log.ElapsedSeconds);
            Attempt = Trial != null ? log.AttemptsAt(Trial.Trial) : 1;
            if (Trial == null)
            {
                Phase = StudyPhase.Disk;
            }
        }

        /// <summary>Raised when phase, trial or attempt changed. Main thread.</summary>
        public event Action<StudySession>? Changed;

        /// <summary>State of the session.</summary>
        public StudyPhase Phase { get; private set; } = StudyPhase.Paused;

        /// <summary>Why the session is paused; valid while it is.</summary>
        public StudyPause Pause { get; private set; } = StudyPause.Begin;

        /// <summary>The present trial, or the next one while it is paused; null after the last.</summary>
        public PlannedTrial? Trial =>
            log.Answered < log.Plan.Trials.Count ? log.Plan.Trials[log.Answered] : null;

        /// <summary>Number of the present attempt at the trial, from 1.</summary>
        public int Attempt { get; private set; }

        /// <summary>Time since the session began, without pauses.</summary>
        public double ElapsedSeconds => clock.ElapsedSeconds;

        /// <summary>The plan of the session.</summary>
        public StudyPlan Plan => log.Plan;

        /// <summary>Why the disk refuses rows; null without an error.</summary>
        public string? Problem => log.Problem;

        /// <summary>Call every frame: counts the time, detects jumps of the clock and retries a disk that refused a
        /// row.</summary>
        /// <param name="nowSeconds">Time of a clock independent of the time of day, such as
        /// Time.realtimeSinceStartupAsDouble.</param>
        public void Advance(double nowSeconds)
        {
            bool isUnderWay = Phase == StudyPhase.Task || Phase == StudyPhase.Question;
            bool isSteady = clock.Advance(nowSeconds, isUnderWay);
            if (isUnderWay && !isSteady)
            {
                Interrupt(StudyPause.ClockJump);
            }
            // After a clock went backwards, the next attempt must not be delayed for long.
            bool isEarly = nowSeconds < nextAttemptSeconds && nowSeconds > nextAttemptSeconds - SecondsBetweenAttempts;
            if (Phase == StudyPhase.Disk && !isEarly)
            {
                nextAttemptSeconds = nowSeconds + SecondsBetweenAttempts;
                WriteAndAdvance();
            }
        }

        /// <summary>Starts the session, or continues after a pause. Otherwise does nothing.</summary>
        public void Continue()
        {
            if (Phase == StudyPhase.Paused)
            {
                BeginTask();
            }
        }

        /// <summary>Pauses the session; the present trial starts again afterwards. Does nothing outside a
        /// trial.</summary>
        public void PauseHere() => Interrupt(StudyPause.Operator);

        /// <summary>Ends the task and opens the question. Does nothing outside a task.</summary>
        public void Ask()
        {
            if (Phase == StudyPhase.Task)
            {
                askedSeconds = clock.ElapsedSeconds;
                SetPhase(StudyPhase.Question);
            }
        }

        /// <summary>Records the participant's answer with times and attempt, and writes it before anything else
        /// happens.</summary>
        /// <returns>False where no question is open, as after a second press of a button: nothing is
        /// recorded.</returns>
        public bool Answer(TrialRecord record)
        {
            if (Phase != StudyPhase.Question)
            {
                return false;
            }
            record.Set("response_seconds", clock.ElapsedSeconds - askedSeconds);
            record.Set("elapsed_seconds", clock.ElapsedSeconds);
            record.Set("attempt", Attempt);
            log.Append(record);
            WriteAndAdvance();
            return true;
        }

        private void Interrupt(StudyPause reason)
        {
            if (Phase == StudyPhase.Task || Phase == StudyPhase.Question)
            {
                ++Attempt;
                Pause = reason;
                SetPhase(StudyPhase.Paused);
            }
        }

        private void WriteAndAdvance()
        {
            bool hadToWait = Phase == StudyPhase.Disk;
            if (!log.TryWritePending() || (Trial == null && !log.IsFinished && !log.Finish()))
            {
                SetPhase(StudyPhase.Disk);
                return;
            }
            Attempt = 1;
            if (Trial == null)
            {
                SetPhase(StudyPhase.Finished);
            }
            else if (Trial.RestBefore || Trial.ChangesSample || hadToWait)
            {
                Pause = hadToWait ? StudyPause.Disk : Trial.RestBefore ? StudyPause.Rest : StudyPause.Sample;
                SetPhase(StudyPhase.Paused);
            }
            else
            {
                BeginTask();
            }
        }

        private void BeginTask() => SetPhase(StudyPhase.Task);

        private void SetPhase(StudyPhase phase)
        {
            Phase = phase;
            Changed?.Invoke(this);
        }
    }

    /// <summary>Counts the seconds of a session with a clock that may stop, jump or go backwards, for example when a
    /// headset is put down or a computer sleeps.</summary>
    internal sealed class SessionClock
    {
        /// <summary>Longest frame while a person takes part.</summary>
        public const double MaximumFrameSeconds = 1.0;

        private double lastSeconds = double.NaN;

        public SessionClock(double elapsedSeconds) => ElapsedSeconds = elapsedSeconds;

        public double ElapsedSeconds { get; private set; }

        /// <param name="counts">False while the session is paused.</param>
        /// <returns>False after a jump, which is not counted.</returns>
        public bool Advance(double nowSeconds, bool counts)
        {
            double passed = nowSeconds - lastSeconds;
            bool isFirst = double.IsNaN(lastSeconds);
            lastSeconds = nowSeconds;
            bool isSteady = passed >= 0.0 && passed <= MaximumFrameSeconds;
            if (counts && isSteady)
            {
                ElapsedSeconds += passed;
            }
            return isSteady || isFirst;
        }
    }
}
