#nullable enable
using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a file with nothing to set.</summary>
    internal abstract class FileInspector : ScriptedImporterEditor
    {
        public override bool showImportedObject => false;

        protected override bool needsApplyRevert => false;

        protected static void DrawNotImported() =>
            EditorGUILayout.HelpBox("This file was not imported; the console says why.", MessageType.Error);
    }

    /// <summary>The Inspector of a .haptomaterial file.</summary>
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

    /// <summary>The Inspector of a .haptoflow file.</summary>
    [CustomEditor(typeof(HapticModelImporter))]
    internal sealed class HapticModelImporterEditor : FileInspector
    {
        private ModelSummary? view;

        public override void OnEnable()
        {
            base.OnEnable();
            view = assetTarget is HapticModelAsset asset ? ModelSummary.Of(asset) : null;
        }

        public override void OnInspectorGUI()
        {
            if (view == null)
            {
                DrawNotImported();
                return;
            }
            view.Draw();
        }
    }

    /// <summary>The Inspector of a model asset that has no .haptoflow file.</summary>
    [CustomEditor(typeof(HapticModelAsset))]
    internal sealed class HapticModelAssetEditor : UnityEditor.Editor
    {
        private ModelSummary? view;

        public override void OnInspectorGUI()
        {
            view ??= ModelSummary.Of((HapticModelAsset)target);
            view.Draw();
        }
    }
}
