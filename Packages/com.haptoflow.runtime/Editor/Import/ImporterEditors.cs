#nullable enable
using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a .haptomaterial file. It shows what the file says; there is nothing to set.</summary>
    [CustomEditor(typeof(HapticMaterialImporter))]
    internal sealed class HapticMaterialImporterEditor : ScriptedImporterEditor
    {
        private readonly MaterialSummaryView view = new MaterialSummaryView();
        private string text = "";

        public override bool showImportedObject => false;

        protected override bool needsApplyRevert => false;

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

    /// <summary>The Inspector of a .haptoflow file. It shows what the file says; there is nothing to set.</summary>
    [CustomEditor(typeof(HapticModelImporter))]
    internal sealed class HapticModelImporterEditor : ScriptedImporterEditor
    {
        private ModelSummaryView? view;

        public override bool showImportedObject => false;

        protected override bool needsApplyRevert => false;

        public override void OnEnable()
        {
            base.OnEnable();
            view = assetTarget is HapticModelAsset asset ? new ModelSummaryView(ModelSummary.Of(asset)) : null;
        }

        public override void OnInspectorGUI()
        {
            if (view == null)
            {
                EditorGUILayout.HelpBox("This file was not imported; the console says why.", MessageType.Error);
                return;
            }
            view.Draw();
        }
    }

    /// <summary>The Inspector of a model asset that has no .haptoflow file.</summary>
    [CustomEditor(typeof(HapticModelAsset))]
    internal sealed class HapticModelAssetEditor : UnityEditor.Editor
    {
        private ModelSummaryView? view;

        public override void OnInspectorGUI()
        {
            view ??= new ModelSummaryView(ModelSummary.Of((HapticModelAsset)target));
            view.Draw();
        }
    }
}
