#nullable enable
using UnityEditor;
using UnityEditor.AssetImporters;

namespace HaptoFlow.Editor
{
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
}
