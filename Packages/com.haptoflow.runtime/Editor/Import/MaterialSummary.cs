#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Files;
using HaptoFlow.Model;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>What the Inspector of a file says: a title and rows, or why the file cannot be used.</summary>
    internal abstract class FileSummary
    {
        /// <summary>The problem of a file that cannot be used, with all other properties empty; else null.</summary>
        public string? Problem { get; protected set; }

        public string Title { get; protected set; } = "";
        public string Description { get; protected set; } = "";

        /// <summary>Only those with a value.</summary>
        public IReadOnlyList<SummaryRow> Rows { get; private set; } = new SummaryRow[0];

        /// <summary>Draws the problem, or title and description.</summary>
        /// <param name="kind">Of the file: "model".</param>
        /// <returns>False if the file cannot be used.</returns>
        public bool DrawHeading(string kind)
        {
            if (Problem != null)
            {
                EditorGUILayout.HelpBox($"This {kind} cannot be used: {Problem}", MessageType.Error);
                return false;
            }
            if (Title.Length > 0)
            {
                EditorGUILayout.LabelField(Title, EditorStyles.boldLabel);
            }
            if (Description.Length > 0)
            {
                EditorGUILayout.LabelField(Description, EditorStyles.wordWrappedLabel);
            }
            return true;
        }

        public void DrawRows()
        {
            foreach (SummaryRow row in Rows)
            {
                EditorGUILayout.LabelField(row.Name, row.Value, EditorStyles.wordWrappedLabel);
            }
        }

        protected void SetRows(IEnumerable<SummaryRow> rows) =>
            Rows = rows.Where(row => row.Value.Length > 0).ToArray();
    }

    /// <summary>The text of a learnt material's Inspector: its nearest label, its recording, and whether it can be used
    /// with the project's model.</summary>
    internal sealed class MaterialSummary : FileSummary
    {
        private MaterialSummary(string problem) => Problem = problem;

        private MaterialSummary(MaterialFile material, HapticModel? model)
        {
            Title = material.Name;
            Description = material.Description;
            bool isOfModel = model != null && model.Space == material.Space;
            SetRows(RowsOf(material, isOfModel ? model : null));
            Mismatch = isOfModel
                ? null
                : model == null
                    ? "The project has no usable model, so nothing is felt."
                    : "Its label is used instead: " + MaterialRegistration.ForeignSpace(material.Space, model.Space);
        }

        /// <summary>Why it cannot be used with the project's model; null when it can.</summary>
        public string? Mismatch { get; }

        /// <param name="text">The text of a material file.</param>
        /// <param name="model">The model in use; null for none.</param>
        public static MaterialSummary Of(string text, HapticModelAsset? model)
        {
            try
            {
                using HapticModel? opened = Opened(model);
                return new MaterialSummary(MaterialFile.Read(text), opened);
            }
            catch (HaptoFlowException refusal)
            {
                return new MaterialSummary(FileProblem.Of(refusal, Encoding.UTF8.GetBytes(text)).Text);
            }
        }

        private static HapticModel? Opened(HapticModelAsset? model)
        {
            try
            {
                return model == null ? null : HapticModel.Open(model.File);
            }
            catch (HaptoFlowException)
            {
                // The model's Inspector reports the problem.
                return null;
            }
        }

        private static IEnumerable<SummaryRow> RowsOf(MaterialFile material, HapticModel? model)
        {
            yield return new SummaryRow("Category", material.Category);
            yield return new SummaryRow("Nearest Label", model?.NearestLabel(material.Embedding) ?? "");
            yield return new SummaryRow("Recording",
                material.Seconds > 0.0 ? SummaryRow.Format("{0:0.#} s", material.Seconds) : "");
            yield return new SummaryRow("Recordings", material.Recordings);
            yield return new SummaryRow("Licence", material.Licence);
            yield return new SummaryRow("Provenance", material.Statement);
            yield return new SummaryRow("Created", material.Created);
            yield return new SummaryRow("Learnt Speeds", Interval(material.SpeedMps, "m/s"));
            yield return new SummaryRow("Learnt Forces", Interval(material.ForceNewtons, "N"));
            yield return new SummaryRow("Stiffness", SummaryRow.Format("{0:0} N/m", material.StiffnessNewtonsPerMetre));
            yield return new SummaryRow("Space", material.Space);
        }

        private static string Interval(TrainedInterval learnt, string unit) =>
            SummaryRow.Format("{0:0.###} to {1:0.###} {2}", learnt.Minimum, learnt.Maximum, unit);
    }

    /// <summary>Draws the summary of a learnt material, and updates it when the text or the model changes.</summary>
    internal sealed class MaterialSummaryView
    {
        private string text = "";
        private HapticModelAsset? model;
        private MaterialSummary? summary;

        /// <param name="material">The text of a material file.</param>
        public void Draw(string material)
        {
            HapticModelAsset? current = LabelCatalog.ModelInUse();
            if (summary == null || !ReferenceEquals(material, text) || !ReferenceEquals(current, model))
            {
                text = material;
                model = current;
                summary = MaterialSummary.Of(material, current);
            }
            if (summary.DrawHeading("material"))
            {
                if (summary.Mismatch != null)
                {
                    EditorGUILayout.HelpBox(summary.Mismatch, MessageType.Warning);
                }
                summary.DrawRows();
            }
        }
    }

    /// <summary>A row of an Inspector: a name and its value, both as text.</summary>
    internal sealed record SummaryRow(string Name, string Value)
    {
        /// <summary>Formats values for a row, the same in every language of the system.</summary>
        public static string Format(string format, params object[] values) =>
            string.Format(CultureInfo.InvariantCulture, format, values);
    }

    /// <summary>Saves learnt materials, as assets with one step of undo each, or as files. Main thread.</summary>
    internal static class MaterialAssets
    {
        private const string AssetExtension = "asset";

        /// <summary>Asks for a path and saves there.</summary>
        /// <param name="text">The text of a material file.</param>
        /// <param name="label">The label that replaces the material where it cannot be used.</param>
        /// <param name="describe">Sets further fields of the asset's description; null to keep them.</param>
        /// <returns>The asset; null when the user cancels.</returns>
        public static HapticMaterial? SaveAs(string text, string label, Action<MaterialDescription>? describe = null)
        {
            string path = EditorUtility.SaveFilePanelInProject("Save as Haptic Material", MaterialFile.Read(text).Name,
                AssetExtension, "The learnt material is saved as an asset. The model does not change.");
            return path.Length > 0 ? Save(path, text, label, describe) : null;
        }

        /// <summary>Saves at a path. An existing material at this path takes the text, and everything that uses it with
        /// it.</summary>
        /// <param name="describe">Sets further fields of the asset's description; null to keep them.</param>
        public static HapticMaterial Save(
            string path, string text, string label, Action<MaterialDescription>? describe = null)
        {
            var existing = AssetDatabase.LoadAssetAtPath<HapticMaterial>(path);
            if (existing != null)
            {
                Undo.RecordObject(existing, "Save " + existing.name);
                existing.Description.Label = label;
                describe?.Invoke(existing.Description);
                existing.Carry(text);
                EditorUtility.SetDirty(existing);
                AssetDatabase.SaveAssetIfDirty(existing);
                return existing;
            }
            HapticMaterial made = HapticMaterial.Create(text, label);
            describe?.Invoke(made.Description);
            AssetDatabase.CreateAsset(made, path);
            Undo.RegisterCreatedObjectUndo(made, "Save " + made.name);
            return made;
        }

        /// <summary>Writes a .haptomaterial file, for the command line and other programs.</summary>
        /// <returns>The problem; null on success.</returns>
        public static string? Export(string path, string text)
        {
            try
            {
                WholeFile.Write(path, text);
                return null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                return error.Message;
            }
        }
    }

    /// <summary>The Inspector of a file with nothing to set.</summary>
    internal abstract class FileInspector : ScriptedImporterEditor
    {
        public override bool showImportedObject => false;

        protected override bool needsApplyRevert => false;

        protected static void DrawNotImported() =>
            EditorGUILayout.HelpBox("This file was not imported; the console says why.", MessageType.Error);
    }

    [CustomEditor(typeof(HapticMaterialImporter))]
    internal sealed class HapticMaterialImporterEditor : FileInspector
    {
        private readonly MaterialSummaryView view = new MaterialSummaryView();
        private string text = "";

        public override void OnEnable()
        {
            base.OnEnable();
            // From the file, because a damaged one has no text in its asset.
            string path = ((AssetImporter)target).assetPath;
            text = HapticMaterialImporter.TextOf(File.ReadAllBytes(FileUtil.GetPhysicalPath(path)));
        }

        public override void OnInspectorGUI()
        {
            view.Draw(text);
            using (new EditorGUI.DisabledScope(!(assetTarget is HapticMaterial { IsLearnt: true })))
            {
                if (GUILayout.Button(HapticMaterialEditor.Preview))
                {
                    TexturePreviewWindow.Open(assetTarget!);
                }
            }
        }
    }
}
