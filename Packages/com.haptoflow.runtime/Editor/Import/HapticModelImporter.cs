#nullable enable
using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;

namespace HaptoFlow.Editor
{
    /// <summary>Imports a .haptoflow file as a <see cref="HapticModelAsset"/>. A damaged file also becomes an asset, so
    /// that references to it still hold when the file is replaced; the problem is shown in the console and in its
    /// Inspector. </summary>
    [ScriptedImporter(1, "haptoflow")]
    public sealed class HapticModelImporter : ScriptedImporter
    {
        /// <inheritdoc/>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            // Asset paths of packages are virtual.
            byte[] file = File.ReadAllBytes(FileUtil.GetPhysicalPath(ctx.assetPath));
            HapticModelAsset asset = HapticModelAsset.Create(file);
            ctx.AddObjectToAsset("model", asset);
            ctx.SetMainObject(asset);
            ModelCheck.ProblemOf(file)?.Log(ctx, asset);
        }
    }
}
