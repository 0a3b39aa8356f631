#nullable enable
using System.Collections.Generic;
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Figures of a running scene as text, made anew ten times a second: to be read, and so that an Inspector
    /// that repaints all the time makes little garbage.</summary>
    internal abstract class Readout<T>
    {
        private const double PeriodSeconds = 0.1;

        private readonly List<SummaryRow> rows = new List<SummaryRow>();
        private double madeSeconds = double.NegativeInfinity;

        public IReadOnlyList<SummaryRow> Rows => rows;

        /// <summary>While controls are laid out only: between that and drawing no row may come.</summary>
        public void Update(T subject)
        {
            double nowSeconds = EditorApplication.timeSinceStartup;
            if (Event.current.type == EventType.Layout && nowSeconds - madeSeconds >= PeriodSeconds)
            {
                madeSeconds = nowSeconds;
                rows.Clear();
                Read(subject);
            }
        }

        protected abstract void Read(T subject);

        protected void Add(string name, string value) => rows.Add(new SummaryRow(name, value));

        protected void Add(string name, string format, params object[] values) =>
            Add(name, string.Format(CultureInfo.InvariantCulture, format, values));
    }
}
