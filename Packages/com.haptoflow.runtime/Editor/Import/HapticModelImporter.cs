#nullable enable
using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;

namespace HaptoFlow.Editor
{
    /// <summary>Makes a <see cref="HapticModelAsset"/> of a .haptoflow file. A damaged file becomes an asset too, so
    /// that what refers to it goes on referring to it when the file is replaced; what is wrong stands in the console
    /// and in its Inspector.</summary>
    [ScriptedImporter(1, "haptoflow")]
    public sealed class HapticModelImporter : ScriptedImporter
    {
        /// <inheritdoc/>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            // Paths of packages are no paths of the disk.
            byte[] file = File.ReadAllBytes(FileUtil.GetPhysicalPath(ctx.assetPath));
            HapticModelAsset asset = HapticModelAsset.Create(file);
            ctx.AddObjectToAsset("model", asset);
            ctx.SetMainObject(asset);
            string? problem = ModelCheck.ProblemOf(file);
            if (problem != null)
            {
                ctx.LogImportError($"HaptoFlow: {ctx.assetPath}: {problem}", asset);
            }
        }
    }
}
