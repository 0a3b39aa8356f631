#nullable enable
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Figures of a running scene as text. They are updated ten times a second, so that they can be read, and
    /// so that an Inspector that repaints all the time allocates little.</summary>
    internal abstract class Readout<T>
    {
        private const double PeriodSeconds = 0.1;

        private readonly List<SummaryRow> rows = new List<SummaryRow>();
        private double lastUpdateSeconds = double.NegativeInfinity;

        /// <summary>Updates the rows when they are due, but only while Unity lays out the Inspector: the number of rows
        /// must not change before it draws.</summary>
        public void Update(T subject)
        {
            double nowSeconds = EditorApplication.timeSinceStartup;
            if (Event.current.type == EventType.Layout && nowSeconds - lastUpdateSeconds >= PeriodSeconds)
            {
                lastUpdateSeconds = nowSeconds;
                rows.Clear();
                Read(subject);
            }
        }

        /// <summary>Draws the rows.</summary>
        public void Draw()
        {
            EditorGUILayout.LabelField("Now", EditorStyles.boldLabel);
            rows.ForEach(row => EditorGUILayout.LabelField(row.Name, row.Value));
        }

        protected abstract void Read(T subject);

        protected void Add(string name, string value) => rows.Add(new SummaryRow(name, value));

        protected void Add(string name, string format, params object[] values) =>
            Add(name, SummaryRow.Format(format, values));
    }
}
