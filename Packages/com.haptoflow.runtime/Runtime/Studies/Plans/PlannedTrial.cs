#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>A trial of a plan. What the study does not vary is null.</summary>
    public sealed class PlannedTrial
    {
        /// <summary>As <see cref="Block"/>: to become familiar with the task.</summary>
        public const string Practice = "practice";

        /// <summary>As <see cref="Block"/>: what the analysis reads.</summary>
        public const string Main = "main";

        internal PlannedTrial(int trial, string block, bool restBefore)
        {
            Trial = trial;
            Block = block;
            RestBefore = restBefore;
        }

        /// <summary>Its place in the plan, from 1.</summary>
        public int Trial { get; }

        /// <summary><see cref="Practice"/> or <see cref="Main"/>.</summary>
        public string Block { get; }

        /// <summary>The study stops before this trial until somebody goes on.</summary>
        public bool RestBefore { get; }

        /// <summary>Similarity study: the trial before was on another material, so that the operator has to mount
        /// another sample first.</summary>
        public bool ChangesSample { get; internal set; }

        /// <summary>Latency study: <see cref="StudyPlan.TurnOn"/> or <see cref="StudyPlan.TurnOff"/>.</summary>
        public string? Condition { get; internal set; }

        /// <summary>Latency study: planned delay from the hand's motion to the vibration's change, in ms.</summary>
        public double? DelayMilliseconds { get; internal set; }

        /// <summary>Similarity study: the material's name in the settings.</summary>
        public string? Material { get; internal set; }

        /// <summary>Similarity study: the method's name in the settings.</summary>
        public string? Method { get; internal set; }

        /// <summary>It belongs to the practice.</summary>
        public bool IsPractice => string.Equals(Block, Practice, StringComparison.Ordinal);
    }
}
