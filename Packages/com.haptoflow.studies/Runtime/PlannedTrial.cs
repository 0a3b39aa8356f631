#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>A trial of a plan. Properties that the study does not vary are null.</summary>
    public sealed class PlannedTrial
    {
        /// <summary>Value of <see cref="Block"/> for trials to become familiar with the task.</summary>
        public const string Practice = "practice";

        /// <summary>Value of <see cref="Block"/> for trials that are analysed.</summary>
        public const string Main = "main";

        internal PlannedTrial(int trial, string block, bool restBefore) =>
            (Trial, Block, RestBefore) = (trial, block, restBefore);

        /// <summary>Number of the trial in the plan, from 1.</summary>
        public int Trial { get; }

        /// <summary><see cref="Practice"/> or <see cref="Main"/>.</summary>
        public string Block { get; }

        /// <summary>True where the study pauses before this trial until the operator continues.</summary>
        public bool RestBefore { get; }

        /// <summary>Similarity study: true where the previous trial had another material, so that the operator has to
        /// mount another sample first.</summary>
        public bool ChangesSample { get; internal set; }

        /// <summary>Latency study: <see cref="StudyPlan.TurnOn"/> or <see cref="StudyPlan.TurnOff"/>.</summary>
        public string? Condition { get; internal set; }

        /// <summary>Latency study: planned delay from the hand's motion to the vibration's change, in ms.</summary>
        public double? DelayMilliseconds { get; internal set; }

        /// <summary>Similarity study: the material's name in the settings.</summary>
        public string? Material { get; internal set; }

        /// <summary>Similarity study: the method's name in the settings.</summary>
        public string? Method { get; internal set; }

        /// <summary>True for a trial of the practice block.</summary>
        public bool IsPractice => string.Equals(Block, Practice, StringComparison.Ordinal);
    }
}
