#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Studies
{
    /// <summary>A kind of study: its name in logs and the columns of its log.</summary>
    public sealed class StudyKind
    {
        /// <summary>The study of the delays between pen and vibration that people notice.</summary>
        public static readonly StudyKind Latency = new StudyKind("latency",
            new[] { "condition", "delay_ms" },
            new[]
            {
                "system_delay_ms", "artificial_delay_ms", "delivered_delay_ms", "starts", "stops", "answer",
            });

        /// <summary>The study of how similar a virtual material feels to the real one.</summary>
        public static readonly StudyKind Similarity = new StudyKind("similarity",
            new[] { "material", "method" },
            new[]
            {
                "delay_ms", "system_delay_ms", "artificial_delay_ms", "delivered_delay_ms", "real_edges_seconds",
                "virtual_edges_seconds", "free_seconds", "rating",
            });

        private StudyKind(string name, string[] planned, string[] own)
        {
            Name = name;
            PlannedColumns = new[] { "trial", "block" }.Concat(planned).ToArray();
            Columns = PlannedColumns.Concat(own).Concat(new[]
            {
                "response_seconds", "elapsed_seconds", "contact_seconds", "path_mm", "mean_speed_mmps",
                "mean_force_newtons", "underruns", "attempt",
            }).ToArray();
        }

        /// <summary>Name in logs: "latency" or "similarity".</summary>
        public string Name { get; }

        /// <summary>Columns of the log, in order.</summary>
        public IReadOnlyList<string> Columns { get; }

        /// <summary>The first columns of the log, whose values the plan determines.</summary>
        public IReadOnlyList<string> PlannedColumns { get; }

        /// <summary>The planned value of a trial for a column.</summary>
        internal static object Planned(PlannedTrial trial, string column) => column switch
        {
            "trial" => trial.Trial,
            "block" => trial.Block,
            "condition" => trial.Condition!,
            "delay_ms" => trial.DelayMilliseconds!.Value,
            "material" => trial.Material!,
            "method" => trial.Method!,
            _ => throw new ArgumentException($"a plan has no column {column}", nameof(column)),
        };
    }
}
