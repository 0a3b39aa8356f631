#nullable enable
using System;
using System.IO;
using HaptoFlow.Files;
using HaptoFlow.Model;
using UnityEditor;

namespace HaptoFlow.Editor
{
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
}
