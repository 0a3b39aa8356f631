#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

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

    /// <summary>Places the fields of a property drawer, one row below the other.</summary>
    internal sealed class InspectorRows
    {
        private readonly SerializedProperty property;
        private Rect row;

        public InspectorRows(Rect position, SerializedProperty property) => (this.property, row) = (
            property, new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight));

        public static float Height(int rows) =>
            rows * (EditorGUIUtility.singleLineHeight + EditorGUIUtility.standardVerticalSpacing) -
            EditorGUIUtility.standardVerticalSpacing;

        public Rect Next()
        {
            Rect place = row;
            row.y += row.height + EditorGUIUtility.standardVerticalSpacing;
            return place;
        }

        /// <summary>Draws a field in the next row; without a title, by its name.</summary>
        public void Field(string name, GUIContent? title = null) =>
            EditorGUI.PropertyField(Next(), property.FindPropertyRelative(name), title);
    }

    /// <summary>Sets a serialised field of assets or components by its path, as one step of undo.</summary>
    internal static class SerializedFields
    {
        public static void Set(Object target, string path, Action<SerializedProperty> set) =>
            Set(new[] { target }, path, set);

        public static void Set(Object[] targets, string path, Action<SerializedProperty> set)
        {
            using var serialized = new SerializedObject(targets);
            set(serialized.FindProperty(path));
            serialized.ApplyModifiedProperties();
        }
    }
}
