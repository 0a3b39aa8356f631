#nullable enable
using System;
using System.IO;
using System.Text;
using HaptoFlow.Model;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Saves learnt materials in the project: as assets that carry them, each one step of undo, or as files.
    /// Main thread.</summary>
    internal static class MaterialAssets
    {
        private const string MaterialEnding = "asset";

        /// <summary>Asks where, and saves there.</summary>
        /// <param name="text">Of a material file.</param>
        /// <param name="label">Felt where the material cannot be.</param>
        /// <param name="describe">What else the asset's description says; null for what it says already.</param>
        /// <returns>Null where the user thought better of it.</returns>
        public static HapticMaterial? SaveAs(string text, string label, Action<MaterialDescription>? describe = null)
        {
            string path = EditorUtility.SaveFilePanelInProject("Save as Haptic Material", MaterialFile.Read(text).Name,
                MaterialEnding, "The material and what it was learnt from become an asset; the model stays as it is.");
            return path.Length > 0 ? Save(path, text, label, describe) : null;
        }

        /// <summary>A material that is there already carries the text from now on, for whoever uses it.</summary>
        /// <param name="describe">What else the asset's description says; null for what it says already.</param>
        public static HapticMaterial Save(
            string path, string text, string label, Action<MaterialDescription>? describe = null)
        {
            var present = AssetDatabase.LoadAssetAtPath<HapticMaterial>(path);
            if (present != null)
            {
                Undo.RecordObject(present, "Save " + present.name);
                present.Description.Label = label;
                describe?.Invoke(present.Description);
                present.Carry(text);
                EditorUtility.SetDirty(present);
                AssetDatabase.SaveAssetIfDirty(present);
                return present;
            }
            HapticMaterial made = HapticMaterial.Create(text, label);
            describe?.Invoke(made.Description);
            AssetDatabase.CreateAsset(made, path);
            Undo.RegisterCreatedObjectUndo(made, "Save " + made.name);
            return made;
        }

        /// <summary>Writes a .haptomaterial file, for the command line and other programs.</summary>
        /// <returns>What went wrong; null where nothing did.</returns>
        public static string? Export(string path, string text)
        {
            try
            {
                File.WriteAllText(path, text, new UTF8Encoding(false));
                return null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                return error.Message;
            }
        }
    }
}
