#nullable enable
using System.IO;
using System.Text;
using HaptoFlow.Model;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Imports a .haptomaterial file as a <see cref="HapticMaterial"/> that contains its embedding. A damaged
    /// file also becomes a material, so that references to it still hold when the file is replaced; the problem is
    /// shown in the console and in its Inspector.</summary>
    [ScriptedImporter(1, "haptomaterial")]
    public sealed class HapticMaterialImporter : ScriptedImporter
    {
        /// <inheritdoc/>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            // Asset paths of packages are virtual.
            string text = ReadText(FileUtil.GetPhysicalPath(ctx.assetPath));
            ctx.DependsOnSourceAsset(ProjectSettingsAsset.DefaultModelPath);
            HapticMaterial material;
            string? problem = null;
            try
            {
                material = HapticMaterial.Create(text, NearestLabel(MaterialFile.Read(text)));
            }
            catch (HaptoFlowException refusal)
            {
                problem = refusal.Message;
                material = ScriptableObject.CreateInstance<HapticMaterial>();
            }
            ctx.AddObjectToAsset("material", material);
            ctx.SetMainObject(material);
            if (problem != null)
            {
                ctx.LogImportError($"HaptoFlow: {ctx.assetPath}: {problem}", material);
            }
        }

        internal static string ReadText(string path) => new UTF8Encoding(false).GetString(File.ReadAllBytes(path));

        /// <summary>The label that replaces the material where the material cannot be used. During an import, only the
        /// package's own model is sure to exist; for materials of other models, it is the default label.</summary>
        private static string NearestLabel(MaterialFile material)
        {
            const string defaultLabel = "wood";
            try
            {
                string path = FileUtil.GetPhysicalPath(ProjectSettingsAsset.DefaultModelPath);
                ModelSpace space = ModelSpace.Of(File.ReadAllBytes(path));
                return space.Id == material.Space ? space.NearestLabel(material.Embedding) : defaultLabel;
            }
            catch (System.Exception error) when (error is IOException || error is HaptoFlowException)
            {
                return defaultLabel;
            }
        }
    }
}
