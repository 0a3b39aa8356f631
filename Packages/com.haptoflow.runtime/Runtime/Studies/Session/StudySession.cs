#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>What a session waits for.</summary>
    public enum StudyPhase
    {
        /// <summary>The operator: <see cref="StudySession.Continue"/>.</summary>
        Paused,

        /// <summary>The participant does the task.</summary>
        Task,

        /// <summary>The participant answers.</summary>
        Question,

        /// <summary>The disk takes no row; it is tried again.</summary>
        Disk,

        /// <summary>Nothing: every trial is answered and written.</summary>
        Finished,
    }

    /// <summary>Why a session is paused.</summary>
    public enum StudyPause
    {
        /// <summary>It has not begun, or not yet gone on after an interruption.</summary>
        Begin,

        /// <summary>The plan has a rest here.</summary>
        Rest,

        /// <summary>The operator mounts another sample.</summary>
        Sample,

        /// <summary>The operator paused it.</summary>
        Operator,

        /// <summary>The clock stopped or jumped in the middle of a trial.</summary>
        ClockJump,

        /// <summary>The disk refused a row and takes it by now.</summary>
        Disk,
    }

    /// <summary>Leads one participant through a plan: which trial is next, when it is asked, when it is written. The
    /// trial in which a session is interrupted begins again, as a further attempt. Main thread.</summary>
    public sealed class StudySession
    {
        private const double SecondsBetweenAttempts = 1.0;

        private readonly StudyLog log;
        private readonly SessionClock clock;
        private int attempt;
        private double askedSeconds;
        private double nextAttemptSeconds;

        /// <summary>Goes on where the log ends; paused until <see cref="Continue"/>.</summary>
        public StudySession(StudyLog log)
        {
            this.log = log;
            clock = new SessionClock(log.ElapsedSeconds);
            attempt = Trial != null ? log.AttemptsAt(Trial.Trial) : 1;
            if (Trial == null)
            {
                Phase = StudyPhase.Disk;
            }
        }

        /// <summary>Phase, trial or attempt changed. Main thread.</summary>
        public event Action<StudySession>? Changed;

        /// <summary>What the session waits for.</summary>
        public StudyPhase Phase { get; private set; } = StudyPhase.Paused;

        /// <summary>Why it is paused, while it is.</summary>
        public StudyPause Pause { get; private set; } = StudyPause.Begin;

        /// <summary>The present trial, or the next one while it is paused; null after the last.</summary>
        public PlannedTrial? Trial =>
            log.Answered < log.Plan.Trials.Count ? log.Plan.Trials[log.Answered] : null;

        /// <summary>How often the present trial was begun.</summary>
        public int Attempt => attempt;

        /// <summary>Since the session began, pauses left out.</summary>
        public double ElapsedSeconds => clock.ElapsedSeconds;

        /// <summary>The plan that is followed.</summary>
        public StudyPlan Plan => log.Plan;

        /// <summary>Why the disk takes nothing; null where nothing is wrong.</summary>
        public string? Problem => log.Problem;

        /// <summary>Every frame: counts the time, notices a clock that jumped, tries a disk again that refused.
        /// </summary>
        /// <param name="nowSeconds">Of a clock that knows no time of day, such as Time.realtimeSinceStartupAsDouble.
        /// </param>
        public void Advance(double nowSeconds)
        {
            bool isUnderWay = Phase == StudyPhase.Task || Phase == StudyPhase.Question;
            bool isSteady = clock.Advance(nowSeconds, isUnderWay);
            if (isUnderWay && !isSteady)
            {
                Interrupt(StudyPause.ClockJump);
            }
            // A clock that went back must not put off the next attempt for long.
            bool isEarly = nowSeconds < nextAttemptSeconds && nowSeconds > nextAttemptSeconds - SecondsBetweenAttempts;
            if (Phase == StudyPhase.Disk && !isEarly)
            {
                nextAttemptSeconds = nowSeconds + SecondsBetweenAttempts;
                GoOn();
            }
        }

        /// <summary>Begins the session, or goes on after a pause. Otherwise nothing happens.</summary>
        public void Continue()
        {
            if (Phase == StudyPhase.Paused)
            {
                BeginTask();
            }
        }

        /// <summary>The operator pauses; the present trial begins again afterwards. While nothing is asked nothing
        /// happens.</summary>
        public void PauseHere() => Interrupt(StudyPause.Operator);

        /// <summary>The task is done and the question appears. Only during a task.</summary>
        public void Ask()
        {
            if (Phase == StudyPhase.Task)
            {
                askedSeconds = clock.ElapsedSeconds;
                Become(StudyPhase.Question);
            }
        }

        /// <summary>The participant's answer: the record is completed with times and attempt, and written before
        /// anything else begins.</summary>
        /// <returns>False where no question is open: then nothing is recorded, as with a button pressed twice.
        /// </returns>
        public bool Answer(TrialRecord record)
        {
            if (Phase != StudyPhase.Question)
            {
                return false;
            }
            record.Set("response_seconds", clock.ElapsedSeconds - askedSeconds);
            record.Set("elapsed_seconds", clock.ElapsedSeconds);
            record.Set("attempt", attempt);
            log.Append(record);
            GoOn();
            return true;
        }

        private void Interrupt(StudyPause reason)
        {
            if (Phase == StudyPhase.Task || Phase == StudyPhase.Question)
            {
                ++attempt;
                Pause = reason;
                Become(StudyPhase.Paused);
            }
        }

        private void GoOn()
        {
            bool hadToWait = Phase == StudyPhase.Disk;
            if (!log.TryWritePending() || (Trial == null && !log.IsFinished && !log.Finish()))
            {
                Become(StudyPhase.Disk);
                return;
            }
            attempt = 1;
            if (Trial == null)
            {
                Become(StudyPhase.Finished);
            }
            else if (Trial.RestBefore || Trial.ChangesSample || hadToWait)
            {
                Pause = hadToWait ? StudyPause.Disk : Trial.RestBefore ? StudyPause.Rest : StudyPause.Sample;
                Become(StudyPhase.Paused);
            }
            else
            {
                BeginTask();
            }
        }

        private void BeginTask() => Become(StudyPhase.Task);

        private void Become(StudyPhase phase)
        {
            Phase = phase;
            Changed?.Invoke(this);
        }
    }
}
