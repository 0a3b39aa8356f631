#nullable enable
using System;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEditor.AssetImporters;

namespace HaptoFlow.Editor
{
    /// <summary>Imports a .hjif file as a <see cref="HapticClip"/>, and .haptic and .ahap files for which it was chosen:
    /// other packages import these by default, and Unity uses neither of two importers that both want to. A damaged
    /// file also becomes a clip, so that references to it still hold when the file is replaced; the problem is shown in
    /// the console and in its Inspector.</summary>
    [ScriptedImporter(1, new[] { "hjif" }, new[] { "haptic", "ahap" })]
    public sealed class HapticClipImporter : ScriptedImporter
    {
        /// <inheritdoc/>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            // Asset paths of packages are virtual.
            byte[] file = File.ReadAllBytes(FileUtil.GetPhysicalPath(ctx.assetPath));
            HapticClip clip = HapticClip.Create(file);
            ctx.AddObjectToAsset("clip", clip);
            ctx.SetMainObject(clip);
            try
            {
                using HapticClipFile read = HapticClipFile.Read(file);
            }
            catch (HaptoFlowException refusal)
            {
                FileProblem.Of(refusal, file).Log(ctx, clip);
            }
        }
    }

    /// <summary>The menu Assets > HaptoFlow: chooses the importer of clips for selected files.</summary>
    internal static class ClipImportMenu
    {
        private const string Import = "Assets/HaptoFlow/Import as Haptic Clip";
        private const int Priority = 1100;

        private static readonly string[] Endings = { ".haptic", ".ahap" };

        [MenuItem(Import, true, Priority)]
        internal static bool CanImport() => SelectedFiles().Length > 0;

        [MenuItem(Import, false, Priority)]
        internal static void ImportSelected()
        {
            foreach (string path in SelectedFiles())
            {
                AssetDatabase.SetImporterOverride<HapticClipImporter>(path);
            }
        }

        private static string[] SelectedFiles() => Selection.objects.Select(AssetDatabase.GetAssetPath)
            .Where(path => Endings.Contains(Path.GetExtension(path), StringComparer.OrdinalIgnoreCase))
            .Distinct().ToArray();
    }
}
