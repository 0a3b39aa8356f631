#nullable enable
using UnityEditor;

namespace HaptoFlow.Editor
{
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
